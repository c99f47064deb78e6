#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "explanation_words.hpp"
#include "moved_hypotheses.hpp"
#include "orientation_hypotheses.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

using IsWrapped = std::array<bool, kJoints>;

/// The angle beside its reading, among those that repeat after `period`, which the orientation of a
/// sample is nearest to.
Eigen::Vector3d unwrapped(const JointGeometry& joints,
                          const Sample& sample,
                          const IsWrapped& is_wrapped,
                          int branches) {
  Eigen::Vector3d best = sample.joint_position;
  double least = std::numeric_limits<double>::infinity();
  std::array<int, kJoints> count = {};
  for (std::size_t k = 0; k < kJoints; ++k) {
    count[k] = is_wrapped[k] ? branches : 1;
  }
  for (int n = 0; n < count[0] * count[1] * count[2]; ++n) {
    const Eigen::Vector3i steps(n % count[0], n / count[0] % count[1], n / (count[0] * count[1]));
    const Eigen::Vector3d q = sample.joint_position + 2.0 * kPi / branches * steps.cast<double>();
    // Small tilts are likelier: half a turn of the outer joints looks nearly like none.
    constexpr double kTiltsAreSmall = 1e-3;
    const double misfit =
        rotationLog(sample.R_stator_rotor * rotorOrientation(joints, q).transpose()).squaredNorm() +
        kTiltsAreSmall * (std::pow(std::remainder(q[0], 2.0 * kPi), 2) +
                          std::pow(std::remainder(q[1], 2.0 * kPi), 2));
    if (misfit < least) {
      least = misfit;
      best = q;
    }
  }
  return best;
}

/// Torques without an orientation cannot tell which angle it was, and serve no more.
Hypothesis wrapped(const IsWrapped& is_wrapped,
                   int branches,
                   const std::string& cause,
                   const std::string& names,
                   double orientations) {
  Hypothesis result;
  result.cause = cause;
  result.family = cause;
  double choices = 1.0;
  for (const bool one : is_wrapped) {
    choices *= one ? branches : 1.0;
  }
  result.cost = orientations * std::log(choices);
  result.correct = [is_wrapped, branches](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    const JointGeometry joints = jointGeometry(wiring.actuator);
    for (Sample& sample : wiring.samples) {
      if (sample.has_orientation) {
        sample.joint_position = unwrapped(joints, sample, is_wrapped, branches);
      } else {
        sample.has_torque = false;
      }
    }
  };
  result.sentence = [names, branches](const Eigen::VectorXd& /*values*/) {
    return names +
           format(
               " read the same angle again after %d deg: take a sensor that tells a whole turn, "
               "or check what its driver makes of it (joint_sensor.yaml).",
               360 / branches);
  };
  return result;
}

bool repeatsWithin(const std::vector<Sample>& samples, std::size_t joint, double period) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const Sample& sample : samples) {
    const double q = sample.joint_position[static_cast<Eigen::Index>(joint)];
    least = std::min(least, q);
    most = std::max(most, q);
  }
  constexpr double kSlack = 1.01;
  return most - least <= kSlack * period;
}

std::vector<Hypothesis> wrappedJoints(const WiringCase& described) {
  const auto orientations = static_cast<double>(
      std::count_if(described.samples.begin(), described.samples.end(), [](const Sample& sample) {
        return sample.has_orientation;
      }));
  std::vector<Hypothesis> all;
  constexpr int kMostBranches = 4;
  for (int branches = 2; branches <= kMostBranches; ++branches) {
    IsWrapped every = {};
    for (std::size_t k = 0; k < kJoints; ++k) {
      every[k] = repeatsWithin(described.samples, k, 2.0 * kPi / branches);
      if (every[k]) {
        IsWrapped one = {};
        one[k] = true;
        all.push_back(wrapped(one,
                              branches,
                              "joint_wrapped:" + numberText(k),
                              "the readings of joint " + described.actuator.joints[k].name,
                              orientations));
      }
    }
    if (std::all_of(every.begin(), every.end(), [](bool one) { return one; })) {
      all.push_back(
          wrapped(every, branches, "joint_wrapped", "the readings of all joints", orientations));
    }
  }
  return all;
}

/// Of a tilt sensor with its axes on the first two joints, where these are at right angles.
std::optional<Hypothesis> turnedTiltSensor(const Actuator& actuator) {
  const Eigen::Vector3d first = actuator.joints[0].axis.normalized();
  const Eigen::Vector3d second = actuator.joints[1].axis.normalized();
  constexpr double kAskew = 0.2;
  if (std::abs(first.dot(second)) > kAskew) {
    return std::nullopt;
  }
  Hypothesis result;
  result.cause = "tilt_turned";
  result.family = result.cause;
  result.start = Eigen::VectorXd::Zero(1);
  result.correct = [](WiringCase& wiring, const Eigen::VectorXd& values) {
    const double c = std::cos(values[0]);
    const double s = std::sin(values[0]);
    for (Sample& sample : wiring.samples) {
      Eigen::Vector3d& q = sample.joint_position;
      // The vertical in the tilted frame, by which such a sensor measures.
      const Eigen::Vector3d down(
          -std::cos(q[0]) * std::sin(q[1]), std::sin(q[0]), std::cos(q[0]) * std::cos(q[1]));
      const Eigen::Vector3d turned(c * down[0] - s * down[1], s * down[0] + c * down[1], down[2]);
      q[0] = std::asin(std::min(std::max(turned[1], -1.0), 1.0));
      q[1] = std::atan2(-turned[0], turned[2]);
    }
  };
  result.is_material = [](const Eigen::VectorXd& values) {
    // Quarters of a turn are signs and orders of the two joints.
    constexpr double kTold = 0.1;
    return std::abs(std::remainder(values[0], 0.5 * kPi)) > kTold;
  };
  result.sentence = [](const Eigen::VectorXd& values) {
    const double angle = -std::remainder(values[0], 2.0 * kPi) / kOneDegree;
    return format(
        "the tilt sensor of the first two joints sits turned by %.4g deg about the "
        "vertical: turn it back, or multiply the `matrix` in joint_sensor.yaml by that rotation.",
        angle);
  };
  return result;
}

}  // namespace

std::vector<ScreenedCandidate> screenReadings(const WiringCase& described,
                                              const CalibrationConfig& config) {
  std::vector<Hypothesis> all = wrappedJoints(described);
  if (const std::optional<Hypothesis> tilt = turnedTiltSensor(described.actuator)) {
    constexpr int kSteps = 24;
    for (int n = 1; n < kSteps; ++n) {
      all.push_back(*tilt);
      all.back().start[0] = 2.0 * kPi * n / kSteps - kPi;
    }
  }
  const double unchanged = orientationLoss(described, config);
  std::vector<ScreenedCandidate> candidates;
  for (const Hypothesis& hypothesis : all) {
    const double gain =
        unchanged - orientationLoss(corrected(described, {hypothesis}, hypothesis.start), config) -
        hypothesis.cost;
    if (gain > 0.0) {
      candidates.push_back({{hypothesis}, gain});
    }
  }
  constexpr std::size_t kMostFitted = 3;
  keepBest(candidates, kMostFitted);
  return candidates;
}

}  // namespace sac
