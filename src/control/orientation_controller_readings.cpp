// What the controller makes of readings: where the rotor is, how it moves, and whether it may be
// there.
#include <cmath>
#include <string>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"

namespace sac {
namespace {

/// Over which the velocity of the model is taken from that of the joints [s].
constexpr double kVelocityStep = 1e-4;

}  // namespace

bool OrientationController::receive(const JointMeasurement& joints) {
  // Far beyond any number of turns, sines lose their digits.
  constexpr double kLargestAngle = 1e6;
  if (!joints.position.allFinite() || joints.position.cwiseAbs().maxCoeff() > kLargestAngle) {
    throw DataError(std::string("The ") + readings() + " are not finite.");
  }
  const double elapsed = measured_ ? secondsBetween(measured_->stamp, joints.stamp) : 0.0;
  const bool is_start = !measured_ || std::abs(elapsed) > kLongestDifference;
  if (!is_start && elapsed <= 0.0) {
    return false;
  }
  if (is_start) {
    joint_velocity_.setZero();
  } else {
    const double share = 1.0 - std::exp(-elapsed * options_.velocity_cutoff);
    joint_velocity_ +=
        share * ((joints.position - measured_->position) / elapsed - joint_velocity_);
  }
  measured_ = joints;
  return true;
}

// Full turns add up, so that a rotor that turns on has no jump of its angles.
bool OrientationController::receive(const OrientationMeasurement& orientation) {
  const Eigen::Vector3d angles = freeRotorAngles(orientation.q_stator_rotor);
  return receive(JointMeasurement{orientation.stamp,
                                  measured_ ? nearestTurns(angles, measured_->position) : angles});
}

RotorState OrientationController::rotorAt(const Eigen::Vector3d& q) const {
  RotorState rotor;
  rotor.R_stator_rotor = rotorOrientation(joints_, q);
  const Eigen::Matrix3d R_before = rotorOrientation(joints_, q - kVelocityStep * joint_velocity_);
  rotor.angular_velocity = rotationLog(R_before.transpose() * rotor.R_stator_rotor) / kVelocityStep;
  return rotor;
}

std::string OrientationController::defectAt(Stamp now) const {
  if (!has_parameters_) {
    return "no parameters have come";
  }
  if (!measured_) {
    return std::string("no ") + readings() + " have come";
  }
  const double age = secondsBetween(measured_->stamp, now);
  if (std::abs(age) > options_.largest_age) {
    return format("the %s are %.2g s old", readings(), age);
  }
  if (!parameters_.workspace.contains(measured_->position, options_.workspace_margin)) {
    return format("the rotor is outside of the workspace, ±%.3g rad of tilt",
                  parameters_.workspace.tilt_limit);
  }
  return {};
}

void OrientationController::receiveCurrents(const CurrentMeasurement& currents) {
  constexpr double kOften = 0.05;  // [s]
  constexpr double kShare = 0.1;
  if (state_ != ControlState::kActive || currents.current.size() != currents_.size() ||
      !currents.current.allFinite()) {
    return;
  }
  if (current_stamp_) {
    const double elapsed = secondsBetween(*current_stamp_, currents.stamp);
    currents_flow_ = currents_flow_ || (elapsed > 0.0 && elapsed < kOften);
  }
  current_stamp_ = currents.stamp;
  measured_sum_ += kShare * (currents.current.cwiseAbs().sum() - measured_sum_);
  commanded_sum_ += kShare * (currents_.cwiseAbs().sum() - commanded_sum_);
}

/// Whoever drives the coils tells what flows in them as long as it is there.
std::string OrientationController::silenceAt(Stamp now) const {
  constexpr double kLongest = 0.25;  // [s]
  const double silence = currents_flow_ ? secondsBetween(*current_stamp_, now) : 0.0;
  return silence > kLongest
             ? format("no measured currents have come for %.2g s: see to the coil driver", silence)
             : std::string();
}

/// What the coils have to do with a rotor that does not follow; nothing: nothing is known.
std::string OrientationController::deviceFault(Stamp now) const {
  constexpr double kSilence = 0.05;  // [s]
  constexpr double kLeast = 0.2;     // [A]
  const double silence = currents_flow_ ? secondsBetween(*current_stamp_, now) : 0.0;
  if (silence > kSilence) {
    return format(", and no measured currents have come for %.2g s: see to the coil driver",
                  silence);
  }
  if (currents_flow_ && commanded_sum_ > kLeast && measured_sum_ < 0.5 * commanded_sum_) {
    return format(", and of %.2g A that are commanded %.2g A flow: see to the amplifier",
                  commanded_sum_,
                  measured_sum_);
  }
  return {};
}

std::string OrientationController::limitAsReason() const {
  return limit_ == CurrentLimit::kNone ? std::string() : "; " + inWords({share_, limit_});
}

}  // namespace sac
