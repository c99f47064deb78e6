#include "spherical_actuator_calibration/control/orientation_reference.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// Of the return from a turn of the reference [s].
constexpr double kReturnDuration = 1.0;

Eigen::Vector3d limited(const Eigen::Vector3d& v, double largest) {
  const double norm = v.norm();
  return norm > largest ? (largest / norm * v).eval() : v;
}

/// From 1 to 0 over `duration`, with neither velocity nor acceleration at both ends.
double fading(double time, double duration) {
  const double t = std::min(1.0, time / duration);
  return 1.0 - t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/// A product of many rotations, back on SO(3).
Eigen::Matrix3d normalized(const Eigen::Matrix3d& R) {
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

}  // namespace

void requireRotation(const Eigen::Matrix3d& R) {
  constexpr double kTolerance = 1e-6;
  const bool is_orthogonal =
      R.allFinite() && (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kTolerance;
  if (!is_orthogonal || R.determinant() < 0.0) {
    throw DataError("The target is no rotation.");
  }
}

void validate(const OrientationReferenceOptions& options) {
  requireInRange("natural_frequency", options.natural_frequency, ValueRange::positive("rad/s"));
  requireInRange("largest_rate", options.largest_rate, ValueRange::positive("rad/s"));
  requireInRange(
      "largest_acceleration", options.largest_acceleration, ValueRange::positive("rad/s²"));
  requireInRange("largest_gap", options.largest_gap, ValueRange::nonNegative("s"));
}

OrientationReference::OrientationReference(const OrientationReferenceOptions& options)
    : options_(options) {
  validate(options);
}

void OrientationReference::reset(const Eigen::Matrix3d& R_stator_rotor) {
  motion_ = DesiredMotion();
  motion_.R_stator_rotor = R_stator_rotor;
  target_ = R_stator_rotor;
  target_velocity_.setZero();
  target_stamp_.reset();
  aside_.setZero();
}

void OrientationReference::setTarget(Stamp stamp, const Eigen::Matrix3d& R_stator_rotor) {
  const double gap = target_stamp_ ? secondsBetween(*target_stamp_, stamp) : 0.0;
  target_velocity_.setZero();
  if (gap > 0.0 && gap <= options_.largest_gap) {
    const Eigen::Vector3d velocity = rotationLog(target_.transpose() * R_stator_rotor) / gap;
    // A target that is farther than the rotor may go in that time is a place to go to.
    if (velocity.norm() <= options_.largest_rate) {
      target_velocity_ = velocity;
    }
  }
  target_interval_ = gap;
  target_ = R_stator_rotor;
  target_stamp_ = stamp;
}

void OrientationReference::turnReference(const Eigen::Matrix3d& rotation_stator) {
  motion_.R_stator_rotor = normalized(rotation_stator * motion_.R_stator_rotor);
  aside_ = rotationLog(rotation_stator * asideRotation());
  aside_age_ = 0.0;
}

Eigen::Matrix3d OrientationReference::asideRotation() const {
  return rotationExp(fading(aside_age_, kReturnDuration) * aside_);
}

// Between two targets of a stream the motion goes on; where the next one is missing, the last one
// is the place to be.
bool OrientationReference::isMoving(Stamp now) const {
  constexpr double kOverdue = 1.5;  // intervals
  return target_stamp_ && secondsBetween(*target_stamp_, now) <= kOverdue * target_interval_;
}

Eigen::Matrix3d OrientationReference::targetAt(Stamp now) const {
  if (!isMoving(now)) {
    return target_;
  }
  return target_ *
         rotationExp(std::max(0.0, secondsBetween(*target_stamp_, now)) * target_velocity_);
}

Eigen::Vector3d OrientationReference::targetVelocityAt(Stamp now) const {
  return isMoving(now) ? target_velocity_ : Eigen::Vector3d::Zero().eval();
}

const DesiredMotion& OrientationReference::advance(Stamp now, double step) {
  // The reference stands at the time of the last call: so must the target, or it would lead by a
  // step.
  const Stamp before = now - static_cast<Stamp>(std::llround(step / kSecondsPerTick));
  const Eigen::Matrix3d R_reference_target =
      motion_.R_stator_rotor.transpose() * asideRotation() * targetAt(before);
  const Eigen::Vector3d target_velocity = R_reference_target * targetVelocityAt(before);
  aside_age_ += step;
  const double frequency = options_.natural_frequency;
  const Eigen::Vector3d wanted_velocity =
      target_velocity +
      limited(0.5 * frequency * rotationLog(R_reference_target), options_.largest_rate);
  motion_.angular_acceleration =
      limited(2.0 * frequency * (wanted_velocity - motion_.angular_velocity),
              options_.largest_acceleration);
  motion_.angular_velocity += step * motion_.angular_acceleration;
  motion_.R_stator_rotor =
      normalized(motion_.R_stator_rotor * rotationExp(step * motion_.angular_velocity));
  return motion_;
}

}  // namespace sac
