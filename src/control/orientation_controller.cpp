#include "spherical_actuator_calibration/control/orientation_controller.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
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
  requireInRange(
      "largest_tracking_error", options.largest_tracking_error, ValueRange::positive("rad"));
  requireInRange("total_current_limit", options.total_current_limit, ValueRange::positive("A"));
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
  const RotorState rotor = rotorAt(q_);
  const Eigen::Vector3d torque =
      torquePerAmpere(curve_, torques_, rotor.R_stator_rotor) * currents_;
  const DesiredMotion& desired = reference_.motion();
  const Eigen::Matrix3d R_desired =
      orientationForTorque(options_.rotor, rotor, desired, torque, options_.gains);
  reference_.turnReference(R_desired * desired.R_stator_rotor.transpose());
}

bool OrientationController::receive(const JointMeasurement& joints) {
  // Far beyond any number of turns, sines lose their digits.
  constexpr double kLargestAngle = 1e6;
  if (!joints.position.allFinite() || joints.position.cwiseAbs().maxCoeff() > kLargestAngle) {
    throw DataError("The joint angles are not finite.");
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

void OrientationController::setTarget(Stamp stamp, const Eigen::Matrix3d& R_stator_rotor) {
  requireRotation(R_stator_rotor);
  requireWay(R_stator_rotor);
  reference_.setTarget(stamp, R_stator_rotor);
}

/// Where the way to a target begins.
Eigen::Matrix3d OrientationController::present() const {
  if (state_ == ControlState::kActive) {
    return reference_.motion().R_stator_rotor;
  }
  return measured_ ? rotorOrientation(joints_, measured_->position)
                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

// The reference goes the shortest way, which may pass outside of the workspace.
void OrientationController::requireWay(const Eigen::Matrix3d& R_stator_rotor) const {
  constexpr int kPoints = 20;
  const Eigen::Matrix3d begin = present();
  const Eigen::Vector3d way = rotationLog(begin.transpose() * R_stator_rotor);
  std::optional<Eigen::Vector3d> q =
      measured_ ? measured_->position : Eigen::Vector3d(Eigen::Vector3d::Zero());
  bool leaves = false;
  for (int n = 1; n <= kPoints && q; ++n) {
    q = jointAngles(joints_, begin * rotationExp(way * n / static_cast<double>(kPoints)), *q);
    leaves = leaves || (q && !isInWorkspace(*q, options_.workspace_margin));
  }
  if (!q || !isInWorkspace(*q, 0.0)) {
    throw DataError(format("The target lies outside of the workspace, ±%.3g rad of tilt.",
                           parameters_.workspace.tilt_limit));
  }
  if (leaves) {
    throw DataError(format(
        "The way to the target leaves the workspace, ±%.3g rad of tilt; go by another target "
        "between.",
        parameters_.workspace.tilt_limit));
  }
}

void OrientationController::enable(Stamp now) {
  if (state_ == ControlState::kActive) {
    return;
  }
  const std::string defect = defectAt(now);
  if (!defect.empty()) {
    throw DataError(defect);
  }
  q_ = measured_->position;
  reference_.reset(rotorAt(q_).R_stator_rotor);
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
  q_ = measured_->position + secondsBetween(measured_->stamp, now) * joint_velocity_;
  const RotorState rotor = rotorAt(q_);
  tracking_error_ = rotationLog(rotor.R_stator_rotor.transpose() * desired.R_stator_rotor).norm();
  if (tracking_error_ > options_.largest_tracking_error) {
    stop(format("the rotor does not follow: it is %.2g rad away", tracking_error_));
    return currents_;
  }
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
  limitTotal();
  return currents_;
}

// As the driver would: all currents alike, so that the torque keeps its direction.
void OrientationController::limitTotal() {
  const double total = currents_.cwiseAbs().sum();
  if (total > options_.total_current_limit) {
    const double share = options_.total_current_limit / total;
    currents_ *= share;
    share_ *= share;
  }
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
  if (state_ != ControlState::kActive) {
    return;
  }
  state_ = ControlState::kStopped;
  stop_reason_ = reason;
  currents_.setZero();
}

}  // namespace sac
