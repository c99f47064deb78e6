#include "spherical_actuator_calibration/core/orientation_controller.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/core/error.hpp"
#include "spherical_actuator_calibration/core/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/core/rotations.hpp"
#include "spherical_actuator_calibration/core/text_format.hpp"
#include "spherical_actuator_calibration/core/value_range.hpp"

namespace spherical_actuator_calibration {
namespace {

/// Readings farther apart tell no velocity [s].
constexpr double kLongestDifference = 0.1;
/// A cycle that came late integrates no further than this [s].
constexpr double kLongestStep = 0.02;
/// Over which the velocity of the model is taken from that of the joints [s].
constexpr double kVelocityStep = 1e-4;

const Actuator& withTorqueModel(const Actuator& actuator) {
  validate(actuator);
  if (!actuator.hasTorqueModel()) {
    throw ConfigError("An actuator without poles, coils and torque curve cannot be controlled.");
  }
  return actuator;
}

void requireRotation(const Eigen::Matrix3d& R) {
  constexpr double kTolerance = 1e-6;
  const bool is_orthogonal =
      R.allFinite() && (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kTolerance;
  if (!is_orthogonal || R.determinant() < 0.0) {
    throw DataError("The target is no rotation.");
  }
}

}  // namespace

void validate(const OrientationControllerOptions& options) {
  validate(options.rotor);
  validate(options.gains);
  validate(options.reference);
  requireInRange("current_limit", options.allocation.current_limit, ValueRange::positive("A"));
  requireInRange("least_singular_value",
                 options.allocation.least_singular_value,
                 ValueRange::positive("N m/A"));
  requireInRange("largest_age", options.largest_age, ValueRange::positive("s"));
  requireInRange("velocity_cutoff", options.velocity_cutoff, ValueRange::positive("rad/s"));
  requireInRange("workspace_margin", options.workspace_margin, ValueRange::nonNegative("rad"));
}

OrientationController::OrientationController(const Actuator& design,
                                             const OrientationControllerOptions& options)
    : parameters_(withTorqueModel(design)),
      options_(options),
      curve_(*design.torque_curve),
      joints_(jointGeometry(design.joints)),
      torques_(torqueGeometry(design)),
      reference_(options.reference),
      currents_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(design.coils.size()))) {
  validate(options);
}

void OrientationController::setParameters(const Actuator& parameters) {
  withTorqueModel(parameters);
  if (parameters.poles.size() != parameters_.poles.size() ||
      parameters.coils.size() != parameters_.coils.size()) {
    throw ConfigError("The parameters belong to an actuator with other poles or coils.");
  }
  parameters_ = parameters;
  joints_ = jointGeometry(parameters.joints);
  torques_ = torqueGeometry(parameters);
  has_parameters_ = true;
  if (state_ == ControlState::kActive) {
    keepTorque();
  }
}

// Orientation and torque look different by other parameters. What the coils do now goes on: the
// reference turns to where the control asks for just that.
void OrientationController::keepTorque() {
  const RotorState rotor = rotorAt(measured_->position);
  const Eigen::Vector3d torque =
      torquePerAmpere(curve_, torques_, rotor.R_stator_rotor) * currents_;
  const DesiredMotion& desired = reference_.motion();
  const Eigen::Matrix3d R_desired =
      orientationForTorque(options_.rotor, rotor, desired, torque, options_.gains);
  reference_.turnReference(R_desired * desired.R_stator_rotor.transpose());
}

void OrientationController::receive(const JointMeasurement& joints) {
  if (!joints.position.allFinite()) {
    throw DataError("The joint angles are not finite.");
  }
  if (!measured_) {
    measured_ = joints;
    return;
  }
  const double elapsed = secondsBetween(measured_->stamp, joints.stamp);
  if (elapsed <= 0.0) {
    return;
  }
  if (elapsed > kLongestDifference) {
    joint_velocity_.setZero();
  } else {
    const double share = 1.0 - std::exp(-elapsed * options_.velocity_cutoff);
    joint_velocity_ +=
        share * ((joints.position - measured_->position) / elapsed - joint_velocity_);
  }
  measured_ = joints;
}

void OrientationController::setTarget(Stamp stamp, const Eigen::Matrix3d& R_stator_rotor) {
  requireRotation(R_stator_rotor);
  const Eigen::Vector3d start =
      measured_ ? measured_->position : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const auto q = jointAngles(joints_, R_stator_rotor, start);
  if (!q || !isInWorkspace(*q, 0.0)) {
    throw DataError(format("The target lies outside of the workspace, ±%.3g rad of tilt.",
                           parameters_.workspace.tilt_limit));
  }
  reference_.setTarget(stamp, R_stator_rotor);
}

void OrientationController::enable(Stamp now) {
  if (state_ == ControlState::kActive) {
    return;
  }
  const std::string defect = defectAt(now);
  if (!defect.empty()) {
    throw DataError(defect);
  }
  reference_.reset(rotorAt(measured_->position).R_stator_rotor);
  last_update_.reset();
  stop_reason_.clear();
  state_ = ControlState::kActive;
}

void OrientationController::disable() {
  state_ = ControlState::kIdle;
  stop_reason_.clear();
  currents_.setZero();
}

const Eigen::VectorXd& OrientationController::update(Stamp now) {
  if (state_ != ControlState::kActive) {
    return currents_;
  }
  const std::string defect = defectAt(now);
  if (!defect.empty()) {
    stop(defect);
    return currents_;
  }
  const double step =
      last_update_ ? std::clamp(secondsBetween(*last_update_, now), 0.0, kLongestStep) : 0.0;
  last_update_ = now;
  const DesiredMotion& desired = reference_.advance(now, step);
  const RotorState rotor =
      rotorAt(measured_->position + secondsBetween(measured_->stamp, now) * joint_velocity_);
  tracking_error_ = rotationLog(rotor.R_stator_rotor.transpose() * desired.R_stator_rotor).norm();
  const AllocatedCurrents allocated =
      allocateCurrents(torquePerAmpere(curve_, torques_, rotor.R_stator_rotor),
                       computedTorque(options_.rotor, rotor, desired, options_.gains),
                       options_.allocation);
  if (allocated.outcome == Allocation::kSingular) {
    stop(format("the coils make no torque in some direction here (%.2g N.m/A)",
                allocated.smallest_singular_value));
    return currents_;
  }
  share_ = allocated.share;
  currents_ = allocated.currents;
  return currents_;
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
    return "no joint angles have come";
  }
  const double age = secondsBetween(measured_->stamp, now);
  if (std::abs(age) > options_.largest_age) {
    return format("the joint angles are %.2g s old", age);
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

void OrientationController::stop(const std::string& reason) {
  state_ = ControlState::kStopped;
  stop_reason_ = reason;
  currents_.setZero();
}

}  // namespace spherical_actuator_calibration
