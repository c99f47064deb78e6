#include "spherical_actuator_calibration/study/model_error.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace sac {
namespace {

constexpr double kOfADrawing = 0.03;  // [rad]
/// Nothing states how good the torque law and the load are: less would be too sure of them [rad].
constexpr double kLeast = 0.005;
constexpr double kDeviations = 4.0;

/// Infinite where it is not stated.
double stated(const std::optional<double>& stddev) {
  return stddev.value_or(std::numeric_limits<double>::infinity());
}

}  // namespace

double likelyModelError(const CalibratedDescription& description) {
  const Actuator& actuator = description.actuator;
  const ParameterStddevs& stddevs = description.stddevs;
  if (stddevs.poles.size() != actuator.poles.size() ||
      stddevs.coils.size() != actuator.coils.size()) {
    return kOfADrawing;
  }
  double worst = 0.0;
  if (actuator.has_joints) {
    for (const JointStddev& joint : stddevs.joints) {
      worst = std::max({worst, stated(joint.offset), stated(joint.axis_u), stated(joint.axis_v)});
    }
  }
  for (const auto* axes : {&stddevs.poles, &stddevs.coils}) {
    for (const AxisStddev& axis : *axes) {
      worst = std::max({worst, stated(axis.polar), stated(axis.azimuth)});
    }
  }
  return std::clamp(kDeviations * worst, kLeast, kOfADrawing);
}

}  // namespace sac
