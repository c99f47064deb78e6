#include "spherical_actuator_calibration/emulation/emulated_sensors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double quantised(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

/// Error of one dwell for `count` of the first `eligible` dwells, each an angle about a random
/// axis.
std::vector<std::optional<Eigen::Matrix3d>> drawDwellErrors(const TrackerOptions& options,
                                                            std::size_t dwells,
                                                            std::uint64_t seed) {
  NoiseSource noise(seed, RandomPurpose::kTrackerBadDwells);
  std::vector<std::optional<Eigen::Matrix3d>> errors(dwells);
  const std::size_t eligible = std::min(dwells, options.poses.value_or(dwells));
  for (std::size_t bad = 0; bad < std::min(options.bad_dwells, eligible);) {
    std::optional<Eigen::Matrix3d>& error = errors[noise.index(eligible)];
    if (!error) {
      error = rotationExp(options.bad_dwell_error * noise.direction());
      ++bad;
    }
  }
  return errors;
}

}  // namespace

void validate(const EmulatedJointOptions& options) {
  validate("joint sensor", options.stream);
  const ValueRange angle = ValueRange::nonNegative("rad");
  requireInRange("joint sensor noise", options.noise, angle);
  requireInRange("joint sensor quantisation", options.quantisation, angle);
  requireInRange("joint sensor glitch", options.glitch, angle);
}

void validate(const TrackerOptions& options) {
  validate("tracker", options.stream);
  const ValueRange angle = ValueRange::nonNegative("rad");
  requireInRange("tracker orientation noise", options.orientation_noise, angle);
  requireInRange("tracker position noise", options.position_noise, ValueRange::nonNegative("m"));
  requireInRange("tracker glitch", options.glitch, angle);
  requireInRange("tracker error of bad dwells", options.bad_dwell_error, angle);
}

void validate(const WrenchSensorOptions& options) {
  validate("wrench", options.stream);
  requireInRange("wrench force noise", options.force_noise, ValueRange::nonNegative("N"));
  requireInRange("wrench torque noise", options.torque_noise, ValueRange::nonNegative("N m"));
  requireInRange("wrench glitch", options.glitch, ValueRange::nonNegative("N m"));
  for (Eigen::Index c = 0; c < 3; ++c) {
    requireInRange("wrench force bias", options.force_bias[c], ValueRange::finite("N"));
    requireInRange("wrench torque bias", options.torque_bias[c], ValueRange::finite("N m"));
  }
}

void validate(const CurrentSensorOptions& options) {
  validate("current", options.stream);
  const ValueRange current = ValueRange::nonNegative("A");
  requireInRange("current noise", options.noise, current);
  requireInRange("current quantisation", options.quantisation, current);
  requireInRange("current glitch", options.glitch, current);
}

EmulatedJointSensor::EmulatedJointSensor(const EmulatedJointOptions& options, std::uint64_t seed)
    : options_(options), noise_(seed, RandomPurpose::kJointNoise) {}

JointMeasurement EmulatedJointSensor::measure(Stamp stamp,
                                              const Eigen::Vector3d& position,
                                              const ScheduledMeasurement& scheduled) {
  JointMeasurement measurement{stamp, position + noise_.gaussianVector(options_.noise)};
  if (scheduled.glitch) {
    measurement.position += options_.glitch * noise_.direction();
  }
  for (double& angle : measurement.position) {
    angle = quantised(angle, options_.quantisation);
  }
  if (scheduled.not_a_number) {
    measurement.position[static_cast<Eigen::Index>(noise_.index(3))] = kNaN;
  }
  return measurement;
}

EmulatedTracker::EmulatedTracker(const TrackerOptions& options,
                                 const Registration& registration,
                                 std::size_t dwells,
                                 std::uint64_t seed)
    : options_(options),
      registration_(registration),
      noise_(seed, RandomPurpose::kTrackerNoise),
      dwell_errors_(drawDwellErrors(options, dwells, seed)) {}

MarkerPoseMeasurement EmulatedTracker::measure(Stamp stamp,
                                               const Eigen::Matrix3d& R_stator_rotor,
                                               std::optional<std::size_t> dwell,
                                               const ScheduledMeasurement& scheduled) {
  Eigen::Matrix3d R_measured =
      rotationExp(noise_.uniformVector(options_.orientation_noise)) * R_stator_rotor;
  if (dwell && dwell_errors_[*dwell]) {
    R_measured = *dwell_errors_[*dwell] * R_measured;
  }
  if (scheduled.glitch) {
    R_measured = rotationExp(options_.glitch * noise_.direction()) * R_measured;
  }
  MarkerPoseMeasurement pose = markerPoseFromOrientation(registration_, stamp, R_measured);
  pose.position += noise_.gaussianVector(options_.position_noise);
  if (scheduled.not_a_number) {
    pose.q_tracker_marker.coeffs()[static_cast<Eigen::Index>(noise_.index(4))] = kNaN;
  }
  return pose;
}

std::vector<std::size_t> EmulatedTracker::badDwells() const {
  std::vector<std::size_t> bad;
  for (std::size_t dwell = 0; dwell < dwell_errors_.size(); ++dwell) {
    if (dwell_errors_[dwell]) {
      bad.push_back(dwell);
    }
  }
  return bad;
}

EmulatedWrenchSensor::EmulatedWrenchSensor(const WrenchSensorOptions& options,
                                           const Registration& registration,
                                           std::uint64_t seed)
    : options_(options), registration_(registration), noise_(seed, RandomPurpose::kWrenchNoise) {}

WrenchMeasurement EmulatedWrenchSensor::measure(Stamp stamp,
                                                const Eigen::Vector3d& torque_rotor,
                                                const Eigen::Vector3d& force_rotor,
                                                const ScheduledMeasurement& scheduled) {
  WrenchMeasurement wrench = wrenchFromTorque(registration_, {stamp, torque_rotor}, force_rotor);
  wrench.force += options_.force_bias + noise_.gaussianVector(options_.force_noise);
  wrench.torque += options_.torque_bias + noise_.gaussianVector(options_.torque_noise);
  if (scheduled.glitch) {
    wrench.torque += options_.glitch * noise_.direction();
  }
  if (scheduled.not_a_number) {
    wrench.torque[static_cast<Eigen::Index>(noise_.index(3))] = kNaN;
  }
  return wrench;
}

EmulatedCurrentSensor::EmulatedCurrentSensor(const CurrentSensorOptions& options,
                                             std::uint64_t seed)
    : options_(options), noise_(seed, RandomPurpose::kCurrentNoise) {}

const CurrentMeasurement& EmulatedCurrentSensor::measure(Stamp stamp,
                                                         const Eigen::VectorXd& current,
                                                         const ScheduledMeasurement& scheduled) {
  measurement_.stamp = stamp;
  measurement_.current = current;
  for (double& reading : measurement_.current) {
    reading += noise_.gaussian(options_.noise);
  }
  const auto coils = static_cast<std::size_t>(current.size());
  if (scheduled.glitch) {
    measurement_.current[static_cast<Eigen::Index>(noise_.index(coils))] += options_.glitch;
  }
  for (double& reading : measurement_.current) {
    reading = quantised(reading, options_.quantisation);
  }
  if (scheduled.not_a_number) {
    measurement_.current[static_cast<Eigen::Index>(noise_.index(coils))] = kNaN;
  }
  return measurement_;
}

}  // namespace sac
