#include "torque_sensor_screen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "material_value.hpp"
#include "predicted_torques.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "torque_screen.hpp"

namespace sac {
namespace {

constexpr const char* kAxes = "xyz";
/// Fewer readings at the end of a range, or alike, may be chance.
constexpr std::size_t kFewestAlike = 4;

Hypothesis torqueAxis(Eigen::Index axis, double factor, double tolerance) {
  Hypothesis result;
  result.cause = std::string("torque_axis:") + static_cast<char>('1' + axis);
  result.family = result.cause;
  result.start = Eigen::VectorXd::Constant(1, factor);
  result.correct = [axis](WiringCase& wiring, const Eigen::VectorXd& values) {
    for (Sample& sample : wiring.samples) {
      sample.torque[axis] *= values[0];
    }
  };
  // The factor on one of three components.
  result.torque_factor = [](const Eigen::VectorXd& values) { return std::cbrt(values[0]); };
  result.is_material = [tolerance](const Eigen::VectorXd& values) {
    return std::abs(values[0] - 1.0) > kMaterial * tolerance;
  };
  result.sentence = [axis](const Eigen::VectorXd& values) {
    return format(
        "the %c component of the measured torques alone must be multiplied by %.4g: check "
        "sign and scale of that channel in the force/torque sensor's driver, and its "
        "calibration matrix.",
        kAxes[axis],
        values[0]);
  };
  return result;
}

/// Readings are at the end of a range within so many standard deviations.
constexpr double kNear = 3.0;
constexpr double kFinest = 1e-4;

/// Torques without current are a bias, or the rotor's weight: alike, and far from any range.
bool mayReachRange(const Sample& sample, double current_threshold) {
  return sample.has_torque && !excitedCoils(sample, current_threshold).empty();
}

struct Rails {
  double current_threshold = 0.0;                  ///< [A]
  Eigen::Vector3d most = Eigen::Vector3d::Zero();  ///< of each channel [N·m]

  bool isReached(const Sample& sample) const {
    const double least = kNear * sample.torque_stddev;
    return mayReachRange(sample, current_threshold) &&
           ((most - sample.torque.cwiseAbs()).array() <= least && most.array() > 2.0 * least).any();
  }
  /// To the last digit, as no noise is: nothing was taken off it afterwards.
  bool isReachedExactly(const Sample& sample) const {
    return isReached(sample) && (sample.torque.cwiseAbs().array() == most.array()).any();
  }
  /// Standard deviation of what was cut off, and of the other components beside it [N·m].
  double unknown() const { return 0.5 * most.maxCoeff(); }
};

/// Torques at the end of the range tell nothing but that: they all are the same number up to noise.
Hypothesis torqueClipped(const Rails& rails, const std::vector<Sample>& samples) {
  Hypothesis result;
  result.cause = "torque_clipped";
  result.family = result.cause;
  std::size_t count = 0;
  const auto exact = static_cast<std::size_t>(
      std::count_if(samples.begin(), samples.end(), [&rails](const Sample& sample) {
        return rails.isReachedExactly(sample);
      }));
  for (const Sample& sample : samples) {
    if (rails.isReached(sample)) {
      ++count;
      const bool is_exact = exact >= kFewestAlike && rails.isReachedExactly(sample);
      const double width =
          std::max(is_exact ? 0.0 : kNear * sample.torque_stddev, kFinest * rails.most.maxCoeff());
      result.cost -= std::log(rails.unknown() / width);
    }
  }
  result.correct = [rails](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    for (Sample& sample : wiring.samples) {
      if (rails.isReached(sample)) {
        sample.torque_stddev = rails.unknown();
      }
    }
  };
  result.sentence = [rails, count](const Eigen::VectorXd& /*values*/) {
    return format(
        "the force/torque sensor is at the end of its range in %zu samples, of which "
        "the largest components are %.3g, %.3g and %.3g N m: lower the currents or take a "
        "larger range, and leave those samples out.",
        count,
        rails.most.x(),
        rails.most.y(),
        rails.most.z());
  };
  return result;
}

Rails railsOf(const std::vector<Sample>& samples, double current_threshold) {
  Rails rails;
  rails.current_threshold = current_threshold;
  for (const Sample& sample : samples) {
    if (mayReachRange(sample, current_threshold)) {
      rails.most = rails.most.cwiseMax(sample.torque.cwiseAbs());
    }
  }
  return rails;
}

std::string stuck(const std::string& what, std::size_t alike, std::size_t count) {
  return format(
      "%s the same number in %zu of %zu samples: the force/torque sensor or its driver "
      "stood still. Check its power, link and stamps, and measure again.",
      what.c_str(),
      alike,
      count);
}

}  // namespace

std::vector<ScreenedCandidate> screenTorqueSensor(const WiringCase& described,
                                                  const CalibrationConfig& config) {
  std::vector<Hypothesis> all;
  Eigen::Vector3d product = Eigen::Vector3d::Zero();
  Eigen::Vector3d predicted = Eigen::Vector3d::Zero();
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
  for (const PredictedTorque& torque : predictTorques(described, config)) {
    const double weight = 1.0 / torque.variance(torque.current);
    product += weight * torque.total.cwiseProduct(torque.measured);
    predicted += weight * torque.total.cwiseAbs2();
    measured += weight * torque.measured.cwiseAbs2();
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (measured[axis] > 0.0 && predicted[axis] > 0.0) {
      const double factor =
          std::copysign(std::sqrt(predicted[axis] / measured[axis]), product[axis]);
      all.push_back(torqueAxis(axis, factor, config.tolerance.effect));
    }
  }
  const Rails rails = railsOf(described.samples, config.estimation.current_threshold);
  const auto reached = static_cast<std::size_t>(std::count_if(
      described.samples.begin(), described.samples.end(), [&rails](const Sample& sample) {
        return rails.isReached(sample);
      }));
  if (reached >= kFewestAlike) {
    all.push_back(torqueClipped(rails, described.samples));
  }
  const double unchanged = torqueLoss(described, config);
  std::vector<ScreenedCandidate> candidates;
  for (Hypothesis& hypothesis : all) {
    const double gain =
        unchanged - torqueLoss(corrected(described, {hypothesis}, hypothesis.start), config);
    candidates.push_back({{std::move(hypothesis)}, gain});
  }
  return candidates;
}

std::optional<std::string> stuckTorques(const std::vector<Sample>& samples) {
  std::array<std::map<double, std::size_t>, 3> alike;
  std::size_t count = 0;
  for (const Sample& sample : samples) {
    if (sample.has_torque) {
      ++count;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ++alike[axis][sample.torque[static_cast<Eigen::Index>(axis)]];
      }
    }
  }
  std::array<std::size_t, 3> most = {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const auto& [value, times] : alike[axis]) {
      most[axis] = std::max(most[axis], times);
    }
  }
  const auto is_stuck = [&](std::size_t times) {
    return times >= kFewestAlike && 4 * times > 3 * count;
  };
  const std::size_t all = *std::min_element(most.begin(), most.end());
  if (is_stuck(all)) {
    return stuck("The measured torque is", all, count);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (is_stuck(most[axis])) {
      return stuck(std::string("The ") + kAxes[axis] + " component of the measured torque is",
                   most[axis],
                   count);
    }
  }
  return std::nullopt;
}

}  // namespace sac
