#include "spherical_actuator_calibration/control/orientation_controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

/// A cycle that came late integrates no further than this [s].
constexpr double kLongestStep = 0.02;
/// A sum of currents that is nearer to its limit is at it.
constexpr double kAtLimit = 1.0 - 1e-9;
/// The observer learns from no reading that is older [s]: its delay would shake the rotor.
constexpr double kLatestLesson = 0.02;

/// The plan with limits that are the controller's as well.
MotionPlan withinLimits(const MotionPlan& plan, const OrientationControllerOptions& options) {
  MotionPlan limited = plan;
  MotionLimits& limits = limited.limits;
  limits.coil_current = std::min(limits.coil_current, options.allocation.current_limit);
  limits.total_current = std::min(limits.total_current, options.total_current_limit);
  limits.square_current = std::min(limits.square_current, options.square_current_limit);
  return limited;
}

const char* nameOf(CurrentLimit limit) {
  switch (limit) {
    case CurrentLimit::kCoil:
      return "current_limit, of one coil";
    case CurrentLimit::kTotal:
      return "total_current_limit, of all coils";
    case CurrentLimit::kPower:
      return "power/limit, of all coils";
    case CurrentLimit::kNone:
      break;
  }
  return "none";
}

std::string singularity(const AllocatedCurrents& allocated) {
  return format("the coils make no torque in some direction here (%.2g N.m/A)",
                allocated.smallest_singular_value);
}

}  // namespace

std::string inWords(const TorqueCut& cut) {
  return format("the currents are at their limit (%s): down to %.0f %% of the wanted torque",
                nameOf(cut.limit),
                100.0 * cut.share);
}

OrientationController::OrientationController(const Actuator& design,
                                             const OrientationControllerOptions& options)
    : parameters_(controllable(design)),
      options_(options),
      configured_unbalance_(options.rotor.unbalance),
      curve_(*design.torque_curve),
      joints_(jointGeometry(design)),
      torques_(torqueGeometry(design)),
      reference_(options.reference),
      disturbance_(options.disturbance, options.velocity_cutoff),
      currents_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(design.coils.size()))) {
  validate(options);
}

// What a motion shows belongs to one set of parameters, and a torque that jumped would be its
// fault: new ones wait.
void OrientationController::setParameters(const Actuator& parameters) {
  controllable(parameters);
  if (parameters.poles.size() != parameters_.poles.size() ||
      parameters.coils.size() != parameters_.coils.size()) {
    throw ConfigError("The parameters belong to an actuator with other poles or coils.");
  }
  if (state_ == ControlState::kActive && isInMotion()) {
    parameters_to_come_ = parameters;
    return;
  }
  parameters_to_come_.reset();
  parameters_ = parameters;
  curve_ = TorqueCurve(*parameters.torque_curve);
  joints_ = jointGeometry(parameters);
  // What was identified stands for what was configured.
  options_.rotor.unbalance =
      parameters.unbalance.isZero(0.0) ? configured_unbalance_ : parameters.unbalance;
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
      orientationForTorque(options_.rotor, rotor, desired, torque + disturbance_.torque(), gains());
  disturbance_.interrupt();
  reference_.turnReference(R_desired * desired.R_stator_rotor.transpose());
}

void OrientationController::setTarget(Stamp stamp, const Eigen::Matrix3d& R_stator_rotor) {
  requireRotation(R_stator_rotor);
  if (isInMotion()) {
    throw DataError("A motion plan is followed: end it before targets are given.");
  }
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
    leaves = leaves || (q && !parameters_.workspace.contains(*q, options_.workspace_margin));
  }
  if (!q || !parameters_.workspace.contains(*q)) {
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
  const Eigen::Vector3d q = measured_->position;
  const Eigen::Matrix3d R_stator_rotor = rotorAt(q).R_stator_rotor;
  const AllocatedCurrents none = allocateCurrents(torquePerAmpere(curve_, torques_, R_stator_rotor),
                                                  Eigen::Vector3d::Zero(),
                                                  options_.allocation);
  if (none.outcome == Allocation::kSingular) {
    throw DataError(singularity(none));
  }
  q_ = q;
  reference_.reset(R_stator_rotor);
  last_update_.reset();
  current_stamp_.reset();
  currents_flow_ = false;
  measured_sum_ = commanded_sum_ = 0.0;
  stop_reason_.clear();
  is_lost_ = false;
  share_ = 1.0;
  limit_ = CurrentLimit::kNone;
  cut_ = {};
  state_ = ControlState::kActive;
}

void OrientationController::disable() {
  if (motion_) {
    motion_->stop();
  }
  state_ = ControlState::kIdle;
  stop_reason_.clear();
  is_lost_ = false;
  currents_.setZero();
  disturbance_.reset();
  takeParametersToCome();
}

const Eigen::VectorXd& OrientationController::update(Stamp now) {
  if (state_ != ControlState::kActive) {
    return currents_;
  }
  for (const std::string& defect : {defectAt(now), silenceAt(now)}) {
    if (!defect.empty()) {
      stop(defect);
      return currents_;
    }
  }
  const double step =
      last_update_ ? std::clamp(secondsBetween(*last_update_, now), 0.0, kLongestStep) : 0.0;
  last_update_ = now;
  const bool was_in_motion = isInMotion();
  const DesiredMotion& desired = desiredMotion(now, step);
  q_ = measured_->position + secondsBetween(measured_->stamp, now) * joint_velocity_;
  const RotorState rotor = rotorAt(q_);
  tracking_error_ = rotationLog(rotor.R_stator_rotor.transpose() * desired.R_stator_rotor).norm();
  const double largest_error =
      isOnItsWay() ? std::min(motion_->plan().limits.error, options_.largest_tracking_error)
                   : options_.largest_tracking_error;
  if (tracking_error_ > largest_error) {
    const std::string fault = deviceFault(now);
    const std::string reason = fault.empty() ? limitAsReason() : fault;
    stop(format("the rotor does not follow: it is %.2g rad away", tracking_error_) + reason);
    is_lost_ = fault.empty();
    return currents_;
  }
  observe(now, rotor);
  allocate(rotor, desired);
  if (was_in_motion && motion_->phase() == MotionPhase::kDone) {
    disable();
  }
  return currents_;
}

const DesiredMotion& OrientationController::desiredMotion(Stamp now, double step) {
  if (!isInMotion()) {
    return reference_.advance(now, step);
  }
  if (motion_->phase() == MotionPhase::kApproach) {
    const DesiredMotion& desired = reference_.advance(now, step);
    approachMotion(step);
    return desired;
  }
  motion_->advance(step);
  motion_reference_ = motion_->desired(joints_);
  return motion_reference_;
}

void OrientationController::approachMotion(double step) {
  const DesiredMotion& reference = reference_.motion();
  const double distance =
      rotationLog(motion_->begin(joints_).transpose() * reference.R_stator_rotor).norm();
  const std::string failure =
      motion_->approach(step, distance, reference.angular_velocity.norm(), joint_velocity_.norm());
  if (!failure.empty()) {
    stop(failure);
  }
}

// A reading that was seen already tells of no further change.
void OrientationController::observe(Stamp now, const RotorState& rotor) {
  const double elapsed = secondsBetween(observed_, measured_->stamp);
  if (elapsed == 0.0) {
    return;
  }
  if (elapsed < 0.0 || elapsed > kLongestDifference) {
    disturbance_.interrupt();
  }
  disturbance_.update(elapsed, options_.rotor, rotor, coil_torque_, learning(now));
  observed_ = measured_->stamp;
}

// What currents at their limit cannot do must not add up. The excitation of a motion plan moves the
// rotor by the errors of the model, which is what it is for: to make up for that would take from
// the motion what was planned to be seen.
Learning OrientationController::learning(Stamp now) const {
  if (isOnItsWay() || secondsBetween(measured_->stamp, now) > kLatestLesson) {
    return Learning::kNone;
  }
  return share_ < 1.0 ? Learning::kNoGrowth : Learning::kFree;
}

void OrientationController::allocate(const RotorState& rotor, const DesiredMotion& desired) {
  if (state_ != ControlState::kActive) {
    return;
  }
  const bool is_in_motion = isInMotion();
  AllocationOptions allocation = options_.allocation;
  if (is_in_motion) {
    allocation.current_limit = std::min(allocation.current_limit, motion_->bounds().coil);
  }
  const Eigen::Matrix3Xd torque_per_ampere =
      torquePerAmpere(curve_, torques_, rotor.R_stator_rotor);
  const Eigen::Vector3d torque =
      computedTorque(options_.rotor, rotor, desired, gains()) - disturbance_.torque();
  const AllocatedCurrents allocated = allocateCurrents(torque_per_ampere, torque, allocation);
  if (allocated.outcome == Allocation::kSingular) {
    stop(singularity(allocated));
    return;
  }
  share_ = allocated.share;
  currents_ = allocated.currents;
  limit_ = share_ < 1.0 ? CurrentLimit::kCoil : CurrentLimit::kNone;
  if (const CurrentLimit of_sum = limitTotal(); of_sum != CurrentLimit::kNone) {
    limit_ = of_sum;
  }
  if (share_ < cut_.share) {
    cut_ = {share_, limit_};
  }
  if (is_in_motion) {
    motion_->noteTorqueShare(share_);
    if (motion_->phase() != MotionPhase::kApproach) {
      currents_ += motion_->excitation(torque_per_ampere, currents_, rotor, desired);
    }
  }
  coil_torque_ = torque_per_ampere * currents_;
}

void OrientationController::follow(const MotionPlan& plan) {
  sac::validate(plan, parameters_);
  if (state_ != ControlState::kActive) {
    throw DataError("The control is not enabled: enable it before a motion.");
  }
  if (isInMotion()) {
    throw DataError("A motion plan is followed already.");
  }
  MotionRun run(withinLimits(plan, options_));
  const Eigen::Matrix3d begin = run.begin(joints_);
  requireWay(begin);
  reference_.setTarget(last_update_.value_or(measured_->stamp), begin);
  motion_ = std::move(run);
  // Its gains are others.
  keepTorque();
}

void OrientationController::endMotion() {
  if (!isInMotion()) {
    return;
  }
  motion_->end();
  // On the approach there is nothing to slow down.
  if (!isInMotion()) {
    disable();
  }
}

MotionProgress OrientationController::motionProgress() {
  if (!motion_) {
    return {};
  }
  const MotionProgress progress = motion_->progress();
  motion_->resetShares();
  return progress;
}

// As the driver would: all currents alike, so that the torque keeps its direction. Returns the
// limit that did it.
CurrentLimit OrientationController::limitTotal() {
  CurrentBounds bounds{options_.allocation.current_limit,
                       options_.total_current_limit,
                       options_.square_current_limit};
  if (isInMotion()) {
    bounds = motion_->bounds();
  }
  const double share = shareWithinSums(currents_, bounds);
  if (share >= 1.0) {
    return CurrentLimit::kNone;
  }
  currents_ *= share;
  share_ *= share;
  const bool is_of_power = currents_.cwiseAbs().sum() < bounds.total * kAtLimit;
  return is_of_power ? CurrentLimit::kPower : CurrentLimit::kTotal;
}

void OrientationController::stop(const std::string& reason) {
  if (state_ != ControlState::kActive) {
    return;
  }
  if (motion_) {
    motion_->stop();
  }
  state_ = ControlState::kStopped;
  stop_reason_ = reason;
  currents_.setZero();
  disturbance_.reset();
  takeParametersToCome();
}

void OrientationController::takeParametersToCome() {
  if (parameters_to_come_) {
    setParameters(Actuator(*parameters_to_come_));
  }
}

}  // namespace sac
