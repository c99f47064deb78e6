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
  if (!isInWorkspace(measured_->position, options_.workspace_margin)) {
    return format("the rotor is outside of the workspace, ±%.3g rad of tilt",
                  parameters_.workspace.tilt_limit);
  }
  return {};
}

bool OrientationController::isInWorkspace(const Eigen::Vector3d& q, double margin) const {
  return q.head<2>().cwiseAbs().maxCoeff() <= parameters_.workspace.tilt_limit + margin;
}

}  // namespace sac
