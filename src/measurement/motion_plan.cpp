#include "spherical_actuator_calibration/measurement/motion_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "spherical_actuator_calibration/actuator/unit_identity.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// A limit is kept where rounding alone exceeds it.
constexpr double kRounding = 1.0 + 1e-9;

/// From 0 to 1 with neither slope nor curvature at both ends, x in [0, 1]; and its integral.
double smoothStep(double x) {
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}
double smoothStepIntegral(double x) {
  return x * x * x * x * (2.5 + x * (x - 3.0));
}

void validate(const std::string& key, const std::vector<Sine>& sines) {
  constexpr double kHighestFrequency = 50.0;  // [Hz] beyond it no loop follows
  for (const Sine& sine : sines) {
    requireInRange(key + " frequency",
                   sine.frequency,
                   {0.0, kHighestFrequency, "Hz", /*minimum_excluded=*/true});
    requireInRange(key + " amplitude", sine.amplitude, ValueRange::nonNegative());
    requireInRange(key + " phase", sine.phase, ValueRange::finite("rad"));
  }
}

void validate(const MotionLimits& limits, const Actuator& actuator) {
  requireInRange("limits tilt", limits.tilt, ValueRange::positive("rad"));
  requireInRange("limits rate", limits.rate, ValueRange::positive("rad/s"));
  requireInRange("limits error", limits.error, ValueRange::positive("rad"));
  requireInRange("limits coil_current", limits.coil_current, ValueRange::positive("A"));
  requireInRange("limits total_current", limits.total_current, ValueRange::positive("A"));
  requireInRange("limits square_current", limits.square_current, ValueRange::positive("A2"));
  requireInRange("limits tilt and error together",
                 limits.tilt + limits.error,
                 ValueRange::closed(0.0, actuator.workspace.tilt_limit * kRounding, "rad"));
}

void requireActuator(const MotionPlan& plan, const Actuator& actuator) {
  if (const auto other = otherUnit(actuator, plan.actuator, plan.serial)) {
    throw ConfigError("The motion plan is for the " + other->kind + " " + other->its +
                      ", not for " + other->own + ".");
  }
  if (plan.coils.size() != actuator.coils.size()) {
    throw ConfigError("The motion plan excites " + std::to_string(plan.coils.size()) +
                      " coils, but the actuator has " + std::to_string(actuator.coils.size()) +
                      ".");
  }
}

}  // namespace

double valueOf(const std::vector<Sine>& sines, double time) {
  double value = 0.0;
  for (const Sine& sine : sines) {
    value += sine.amplitude * std::sin(2.0 * kPi * sine.frequency * time + sine.phase);
  }
  return value;
}

double largestValueOf(const std::vector<Sine>& sines) {
  double sum = 0.0;
  for (const Sine& sine : sines) {
    sum += sine.amplitude;
  }
  return sum;
}

double largestRateOf(const std::vector<Sine>& sines) {
  double sum = 0.0;
  for (const Sine& sine : sines) {
    sum += 2.0 * kPi * sine.frequency * sine.amplitude;
  }
  return sum;
}

Eigen::Vector3d jointsAt(const MotionPlan& plan, double time) {
  Eigen::Vector3d q;
  for (std::size_t k = 0; k < kJoints; ++k) {
    q[static_cast<Eigen::Index>(k)] = plan.joints[k].centre + valueOf(plan.joints[k].sines, time);
  }
  return q;
}

Eigen::VectorXd excitationAt(const MotionPlan& plan, double time) {
  Eigen::VectorXd currents(static_cast<Eigen::Index>(plan.coils.size()));
  for (std::size_t j = 0; j < plan.coils.size(); ++j) {
    currents[static_cast<Eigen::Index>(j)] = valueOf(plan.coils[j], time);
  }
  return currents;
}

void validate(const MotionPlan& plan, const Actuator& actuator) {
  constexpr double kLongest = 3600.0;  // [s]
  requireActuator(plan, actuator);
  requireInRange("duration", plan.duration, ValueRange::closed(0.1, kLongest, "s"));
  requireInRange("ramp", plan.ramp, ValueRange::closed(0.01, 0.5 * plan.duration, "s"));
  validate(plan.limits, actuator);
  for (std::size_t k = 0; k < kJoints; ++k) {
    const std::string name = "joint " + std::to_string(numberOf(k));
    const JointMotion& joint = plan.joints[k];
    requireInRange(name + " centre", joint.centre, ValueRange::finite("rad"));
    validate(name, joint.sines);
    requireInRange(name + " rate, at most",
                   largestRateOf(joint.sines),
                   ValueRange::closed(0.0, plan.limits.rate * kRounding, "rad/s"));
    if (k < 2) {
      requireInRange(name + " tilt, at most",
                     std::abs(joint.centre) + largestValueOf(joint.sines),
                     ValueRange::closed(0.0, plan.limits.tilt * kRounding, "rad"));
    }
  }
  for (std::size_t j = 0; j < plan.coils.size(); ++j) {
    const std::string name = "coil " + std::to_string(numberOf(j));
    validate(name, plan.coils[j]);
    requireInRange(name + " excitation, at most",
                   largestValueOf(plan.coils[j]),
                   ValueRange::closed(0.0, plan.limits.coil_current * kRounding, "A"));
  }
}

double MotionTime::at(double time) const {
  if (is_ended_ && time > ended_at_) {
    return plan_then_ + since(ended_at_, rate_then_, time);
  }
  const double t = std::clamp(time, 0.0, duration_);
  const double end_begin = duration_ - ramp_;
  if (t < ramp_) {
    return ramp_ * smoothStepIntegral(t / ramp_);
  }
  return t <= end_begin ? t - 0.5 * ramp_ : end_begin - 0.5 * ramp_ + since(end_begin, 1.0, t);
}

double MotionTime::rateAt(double time) const {
  if (is_ended_ && time > ended_at_) {
    return rate_then_ * (1.0 - smoothStep(std::min(1.0, (time - ended_at_) / ramp_)));
  }
  const double t = std::clamp(time, 0.0, duration_);
  const double to_an_end = std::min(t, duration_ - t) / ramp_;
  return smoothStep(std::clamp(to_an_end, 0.0, 1.0));
}

void MotionTime::endAt(double time) {
  if (is_ended_ || time >= duration_ - ramp_) {
    return;
  }
  rate_then_ = rateAt(time);
  plan_then_ = at(time);
  ended_at_ = std::max(0.0, time);
  duration_ = ended_at_ + ramp_;
  is_ended_ = true;
}

/// What the time of the plan gains while it slows down from a rate.
double MotionTime::since(double end_begin, double rate, double time) const {
  const double x = std::clamp((time - end_begin) / ramp_, 0.0, 1.0);
  return rate * ramp_ * (x - smoothStepIntegral(x));
}

}  // namespace sac
