#include "spherical_actuator_calibration/control/motion_run.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// The rotor must rest at the begin, and at the end, for so long [s].
constexpr double kSettling = 0.5;
/// An approach that takes longer than this does not succeed [s].
constexpr double kLongestApproach = 30.0;
/// Of the reference at its begin [rad], [rad/s].
constexpr double kThere = 1e-3;
/// Of a rotor that counts as resting [rad/s].
constexpr double kResting = 0.1;
/// By a model that is far off a rotor without friction may never rest, and is held all the same:
/// after so long [s] it may begin with as much [rad/s].
constexpr double kPatience = 10.0;
constexpr double kRestless = 0.6;
/// Shares of the limit of the tracking error between which the excitation fades.
constexpr double kFadeBegin = 0.4;
constexpr double kFadeEnd = 0.8;
/// A rotor that drifts away is judged by where it will be then [s].
constexpr double kLookAhead = 0.08;

}  // namespace

const char* motionPhaseName(MotionPhase phase) {
  switch (phase) {
    case MotionPhase::kNone:
      return "none";
    case MotionPhase::kApproach:
      return "approach";
    case MotionPhase::kMotion:
      return "motion";
    case MotionPhase::kEnding:
    case MotionPhase::kSettling:
      return "ending";
    case MotionPhase::kDone:
      return "done";
    case MotionPhase::kStopped:
      return "stopped";
  }
  return "none";
}

bool isRunning(MotionPhase phase) {
  return phase == MotionPhase::kApproach || phase == MotionPhase::kMotion ||
         phase == MotionPhase::kEnding || phase == MotionPhase::kSettling;
}

MotionRun::MotionRun(const MotionPlan& plan)
    : plan_(plan),
      time_(plan.duration, plan.ramp),
      bounds_{plan.limits.coil_current, plan.limits.total_current, plan.limits.square_current} {
  progress_.phase = MotionPhase::kApproach;
  progress_.duration = plan.duration;
}

Eigen::Matrix3d MotionRun::begin(const JointGeometry& joints) const {
  return rotorOrientation(joints, jointsAt(plan_, 0.0));
}

std::string MotionRun::approach(double step,
                                double distance,
                                double reference_rate,
                                double rotor_rate) {
  waited_ += step;
  const double resting = waited_ < kPatience ? kResting : kRestless;
  const bool is_there = distance < kThere && reference_rate < kThere && rotor_rate < resting;
  settled_ = is_there ? settled_ + step : 0.0;
  if (settled_ >= kSettling) {
    progress_.phase = MotionPhase::kMotion;
    settled_ = 0.0;
  }
  return waited_ > kLongestApproach ? "the rotor does not come to rest where the motion begins"
                                    : "";
}

void MotionRun::advance(double step) {
  progress_.elapsed = std::min(progress_.elapsed + step, time_.end());
  progress_.duration = time_.end();
  if (progress_.elapsed < time_.end()) {
    return;
  }
  progress_.phase = MotionPhase::kSettling;
  settled_ += step;
  if (settled_ >= kSettling) {
    progress_.phase = MotionPhase::kDone;
  }
}

void MotionRun::end() {
  if (progress_.phase == MotionPhase::kApproach) {
    progress_.phase = MotionPhase::kDone;
  } else if (progress_.phase == MotionPhase::kMotion) {
    time_.endAt(progress_.elapsed);
    progress_.phase = MotionPhase::kEnding;
  }
}

void MotionRun::stop() {
  if (isRunning()) {
    progress_.phase = MotionPhase::kStopped;
  }
}

// Velocity and acceleration by differences of exact orientations, so short that nothing of a motion
// is lost, and so long that nothing of the digits is.
DesiredMotion MotionRun::desired(const JointGeometry& joints) const {
  constexpr double kDifference = 1e-3;  // [s]
  const auto at = [&](double time) {
    return rotorOrientation(joints, jointsAt(plan_, time_.at(time)));
  };
  const double now = progress_.elapsed;
  DesiredMotion desired;
  desired.R_stator_rotor = at(now);
  const Eigen::Vector3d ahead =
      rotationLog(desired.R_stator_rotor.transpose() * at(now + kDifference));
  const Eigen::Vector3d back =
      rotationLog(desired.R_stator_rotor.transpose() * at(now - kDifference));
  desired.angular_velocity = (ahead - back) / (2.0 * kDifference);
  desired.angular_acceleration = (ahead + back) / (kDifference * kDifference);
  return desired;
}

Eigen::VectorXd MotionRun::excitation(const Eigen::Matrix3Xd& torque_per_ampere,
                                      const Eigen::VectorXd& control,
                                      const RotorState& rotor,
                                      const DesiredMotion& desired) {
  const Eigen::Matrix3d R_rotor_desired = rotor.R_stator_rotor.transpose() * desired.R_stator_rotor;
  const Eigen::Vector3d offset = rotationLog(R_rotor_desired);
  const Eigen::Vector3d drift = R_rotor_desired * desired.angular_velocity - rotor.angular_velocity;
  progress_.largest_tracking_error = std::max(progress_.largest_tracking_error, offset.norm());
  const double error =
      std::max(offset.norm(), (offset + kLookAhead * drift).norm()) / plan_.limits.error;
  const double fading = std::clamp((kFadeEnd - error) / (kFadeEnd - kFadeBegin), 0.0, 1.0);
  const Eigen::VectorXd wanted =
      time_.rateAt(progress_.elapsed) *
      withoutTorque(torque_per_ampere, excitationAt(plan_, time_.at(progress_.elapsed)));
  const double share = fading * excitationShare(control, fading * wanted, bounds_);
  progress_.least_excitation_share = std::min(progress_.least_excitation_share, share);
  return share * wanted;
}

void MotionRun::noteTorqueShare(double share) {
  progress_.least_torque_share = std::min(progress_.least_torque_share, share);
}

void MotionRun::resetShares() {
  progress_.least_excitation_share = 1.0;
  progress_.least_torque_share = 1.0;
}

}  // namespace sac
