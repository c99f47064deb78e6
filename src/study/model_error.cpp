#include "spherical_actuator_calibration/study/model_error.hpp"

#include <algorithm>

namespace sac {
namespace {

constexpr double kOfADrawing = 0.03;  // [rad]
/// Nothing states how good the torque law and the load are: less would be too sure of them [rad].
constexpr double kLeast = 0.005;
constexpr double kDeviations = 4.0;

}  // namespace

double likelyModelError(const CalibratedDescription& description) {
  if (isAsDrawn(description)) {
    return kOfADrawing;
  }
  const ParameterStddevs& stddevs = description.stddevs;
  double worst = 0.0;
  if (description.actuator.has_joints) {
    for (const JointStddev& joint : stddevs.joints) {
      worst = std::max({worst, *joint.offset, *joint.axis_u, *joint.axis_v});
    }
  }
  for (const auto* axes : {&stddevs.poles, &stddevs.coils}) {
    for (const AxisStddev& axis : *axes) {
      worst = std::max({worst, *axis.polar, *axis.azimuth});
    }
  }
  return std::clamp(kDeviations * worst, kLeast, kOfADrawing);
}

}  // namespace sac
