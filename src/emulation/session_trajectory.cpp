#include "spherical_actuator_calibration/emulation/session_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// Peak speed of a minimum-jerk move, relative to its mean speed.
constexpr double kMinimumJerkPeak = 1.875;

/// Time constants after which a current counts as settled: what is left is far below any sensor.
constexpr double kSettledAfter = 30.0;

/// Share of a minimum-jerk move that is done after the share t of its time.
double minimumJerk(double t) {
  return t * t * t * (10.0 + t * (-15.0 + 6.0 * t));
}

}  // namespace

void validate(const SessionTiming& timing) {
  const ValueRange duration = ValueRange::positive("s");
  const ValueRange optional_duration = ValueRange::nonNegative("s");
  requireInRange("move", timing.move, duration);
  requireInRange("peak joint speed", timing.peak_joint_speed, ValueRange::positive("rad/s"));
  requireInRange("settle", timing.settle, optional_duration);
  requireInRange("zero current", timing.zero_current, optional_duration);
  requireInRange("pattern", timing.pattern, duration);
  requireInRange("release", timing.release, optional_duration);
  requireInRange("orientation only", timing.orientation_only, duration);
  requireInRange("current time constant", timing.current_time_constant, optional_duration);
}

SessionTrajectory::SessionTrajectory(const SessionPlan& plan,
                                     const SessionTiming& timing,
                                     std::size_t coils)
    : timing_(timing), no_current_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils))) {
  validate(plan, coils);
  validate(timing);
  for (std::size_t index = 0; index < plan.dwells.size(); ++index) {
    appendDwell(plan.dwells[index], index);
  }
}

void SessionTrajectory::appendDwell(const PlannedDwell& dwell, std::size_t index) {
  const Eigen::Vector3d& pose = dwell.joint_position;
  append(moveDuration(pose), pose, no_current_, std::nullopt);
  const double begin = duration();
  append(timing_.settle, pose, no_current_, index);
  if (dwell.patterns.empty()) {
    append(timing_.orientation_only, pose, no_current_, index);
  } else {
    append(timing_.zero_current, pose, no_current_, index);
    for (const Eigen::VectorXd& pattern : dwell.patterns) {
      append(timing_.pattern, pose, pattern, index);
    }
  }
  append(timing_.release, pose, no_current_, index);
  dwells_.push_back({begin, duration()});
}

void SessionTrajectory::append(double duration,
                               const Eigen::Vector3d& to,
                               const Eigen::VectorXd& target_current,
                               std::optional<std::size_t> dwell) {
  Phase phase{0.0, duration, Eigen::Vector3d::Zero(), to, no_current_, target_current, dwell};
  if (!phases_.empty()) {
    const Phase& previous = phases_.back();
    phase.begin = previous.end;
    phase.end = previous.end + duration;
    phase.from = previous.to;
    currentIn(previous, previous.end, phase.start_current);
  }
  phases_.push_back(phase);
}

double SessionTrajectory::moveDuration(const Eigen::Vector3d& to) const {
  const Eigen::Vector3d from = phases_.empty() ? Eigen::Vector3d::Zero() : phases_.back().to;
  const double distance = (to - from).cwiseAbs().maxCoeff();
  return std::max(timing_.move, kMinimumJerkPeak * distance / timing_.peak_joint_speed);
}

void SessionTrajectory::currentIn(const Phase& phase, double time, Eigen::VectorXd& current) const {
  const double elapsed = time - phase.begin;
  if (elapsed >= kSettledAfter * timing_.current_time_constant) {
    current = phase.target_current;
    return;
  }
  const double remaining = std::exp(-elapsed / timing_.current_time_constant);
  current = phase.target_current + remaining * (phase.start_current - phase.target_current);
}

const SessionState& SessionTrajectory::at(double time) {
  while (phase_ + 1 < phases_.size() && time >= phases_[phase_].end) {
    ++phase_;
  }
  const Phase& phase = phases_[phase_];
  state_.dwell = phase.dwell;
  currentIn(phase, time, state_.current);
  if (phase.dwell) {
    state_.joint_position = phase.to;
    return state_;
  }
  const double share = std::min(1.0, (time - phase.begin) / (phase.end - phase.begin));
  state_.joint_position = phase.from + minimumJerk(share) * (phase.to - phase.from);
  return state_;
}

}  // namespace sac
