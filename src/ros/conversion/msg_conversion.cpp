#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

namespace sac {
namespace {

Eigen::Matrix3d rotationFromRos(const geometry_msgs::Quaternion& message, std::uint32_t id) {
  const Eigen::Quaterniond q = quaternionFromRos(message);
  if (!isUnit(q)) {
    throw DataError("Sample " + std::to_string(id) + ": orientation is not a unit quaternion.");
  }
  return q.normalized().toRotationMatrix();
}

msg::SampleResidual residualToRos(const SampleResidual& residual) {
  msg::SampleResidual message;
  message.id = residual.id;
  message.unit = unitOf(residual.quantity);
  message.residual = residual.residual;
  message.standardized = residual.standardized;
  message.rejected = static_cast<std::uint8_t>(residual.rejected);
  message.reason = residual.reason;
  message.quantity = quantityName(residual.quantity);
  return message;
}

void fillGrade(const GradedCalibration& graded, msg::CalibrationReport& message) {
  message.grade = gradeName(graded.grade);
  message.grade_reason = graded.reason;
}

}  // namespace

msg::ParameterEstimate estimateToRos(const ParameterEstimate& estimate) {
  msg::ParameterEstimate message;
  message.name = estimate.name;
  message.unit = estimate.unit;
  message.nominal = estimate.nominal;
  message.initial = estimate.initial;
  message.value = estimate.value;
  // Of what is not identified.
  message.stddev = std::numeric_limits<double>::infinity();
  if (estimate.observable) {
    message.stddev = estimate.stddev;
  }
  message.observable = static_cast<std::uint8_t>(estimate.observable);
  return message;
}

Eigen::Vector3d vectorFromRos(const geometry_msgs::Vector3& message) {
  return {message.x, message.y, message.z};
}

geometry_msgs::Vector3 vectorToRos(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Point pointToRos(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

Eigen::Quaterniond quaternionFromRos(const geometry_msgs::Quaternion& message) {
  return {message.w, message.x, message.y, message.z};
}

geometry_msgs::Quaternion quaternionToRos(const Eigen::Quaterniond& quaternion) {
  geometry_msgs::Quaternion message;
  message.x = quaternion.x();
  message.y = quaternion.y();
  message.z = quaternion.z();
  message.w = quaternion.w();
  return message;
}

OrientationMeasurement orientationFromRos(const geometry_msgs::QuaternionStamped& message) {
  return {stampFromRos(message.header.stamp), quaternionFromRos(message.quaternion)};
}

TorqueMeasurement torqueFromRos(const geometry_msgs::Vector3Stamped& message) {
  return {stampFromRos(message.header.stamp), vectorFromRos(message.vector)};
}

void currentFromRos(const msg::CoilCurrents& message, CurrentMeasurement& measurement) {
  measurement.stamp = stampFromRos(message.header.stamp);
  measurement.current = Eigen::Map<const Eigen::VectorXd>(
      message.current.data(), static_cast<Eigen::Index>(message.current.size()));
}

std::optional<JointMeasurement> JointStateReader::read(const sensor_msgs::JointState& message) {
  if (!locate(message)) {
    return std::nullopt;
  }
  JointMeasurement measurement;
  measurement.stamp = stampFromRos(message.header.stamp);
  for (std::size_t k = 0; k < kJoints; ++k) {
    if (places_[k] >= message.position.size()) {
      return std::nullopt;
    }
    measurement.position[static_cast<Eigen::Index>(k)] = message.position[places_[k]];
  }
  return measurement;
}

bool JointStateReader::locate(const sensor_msgs::JointState& message) {
  for (std::size_t k = 0; k < kJoints; ++k) {
    if (places_[k] < message.name.size() && message.name[places_[k]] == names_[k]) {
      continue;
    }
    const auto found = std::find(message.name.begin(), message.name.end(), names_[k]);
    if (found == message.name.end()) {
      return false;
    }
    places_[k] = static_cast<std::size_t>(found - message.name.begin());
  }
  return true;
}

Sample sampleFromRos(const msg::CalibrationSample& message) {
  Sample sample;
  sample.id = message.id;
  sample.stamp = stampFromRos(message.header.stamp);
  sample.validation = message.validation != 0;
  sample.joint_position = Eigen::Map<const Eigen::Vector3d>(message.joint_position.data());
  sample.joint_stddev = Eigen::Map<const Eigen::Vector3d>(message.joint_stddev.data());
  sample.has_orientation = message.has_orientation != 0;
  if (sample.has_orientation) {
    sample.R_stator_rotor = rotationFromRos(message.orientation, message.id);
  }
  sample.orientation_stddev = message.orientation_stddev;
  sample.has_torque = message.has_torque != 0;
  sample.torque = vectorFromRos(message.torque);
  sample.torque_stddev = message.torque_stddev;
  sample.current = Eigen::Map<const Eigen::VectorXd>(
      message.current.data(), static_cast<Eigen::Index>(message.current.size()));
  sample.duration = message.duration;
  sample.measurements = message.measurements;
  sample.dwell = stampFromRos(message.dwell);
  sample.joint_shared_stddev =
      Eigen::Map<const Eigen::Vector3d>(message.joint_shared_stddev.data());
  sample.torque_shared_stddev = message.torque_shared_stddev;
  return sample;
}

msg::CalibrationSample sampleToRos(const Sample& sample) {
  msg::CalibrationSample message;
  message.header.stamp = stampToRos(sample.stamp);
  message.id = sample.id;
  message.validation = static_cast<std::uint8_t>(sample.validation);
  std::copy_n(sample.joint_position.data(), kJoints, message.joint_position.begin());
  std::copy_n(sample.joint_stddev.data(), kJoints, message.joint_stddev.begin());
  message.has_orientation = static_cast<std::uint8_t>(sample.has_orientation);
  message.orientation = quaternionToRos(Eigen::Quaterniond(sample.R_stator_rotor));
  message.orientation_stddev = sample.orientation_stddev;
  message.has_torque = static_cast<std::uint8_t>(sample.has_torque);
  message.torque = vectorToRos(sample.torque);
  message.torque_stddev = sample.torque_stddev;
  message.current.assign(sample.current.begin(), sample.current.end());
  message.duration = sample.duration;
  message.measurements = sample.measurements;
  message.dwell = stampToRos(sample.dwell);
  std::copy_n(sample.joint_shared_stddev.data(), kJoints, message.joint_shared_stddev.begin());
  message.torque_shared_stddev = sample.torque_shared_stddev;
  return message;
}

msg::CalibrationReport reportToRos(const CycleReport& report, const GradedCalibration& graded) {
  msg::CalibrationReport message;
  message.cycle = cycleName(report.cycle);
  message.coil = numberOrZero(report.coil);
  message.success = static_cast<std::uint8_t>(report.success);
  message.message = report.message;
  message.samples_used = report.samples_used;
  message.samples_rejected = report.samples_rejected;
  message.iterations = report.iterations;
  message.error_history = report.error_history;
  message.error_unit = unitOf(report.error_measure);
  message.reduced_chi_square = report.reduced_chi_square;
  message.condition_number = report.condition_number;
  message.solve_time = report.solve_time;
  std::transform(report.estimates.begin(),
                 report.estimates.end(),
                 std::back_inserter(message.estimates),
                 estimateToRos);
  std::transform(report.residuals.begin(),
                 report.residuals.end(),
                 std::back_inserter(message.residuals),
                 residualToRos);
  message.orientation_uncertainty = report.orientation_uncertainty;
  message.torque_uncertainty = report.torque_uncertainty;
  fillGrade(graded, message);
  return message;
}

msg::CalibrationReport validationToRos(const HeldOutValidation& validation,
                                       const GradedCalibration& graded) {
  msg::CalibrationReport message;
  message.cycle = msg::CalibrationReport::VALIDATE;
  const bool agrees = validation.hasVerdict() && validation.probability >= kLeastProbability;
  const bool is_contradicted = graded.grade == Grade::kContradicted;
  message.success = static_cast<std::uint8_t>(agrees && !is_contradicted);
  message.message = verdict(validation);
  if (agrees && is_contradicted) {  // by the newest of them, or by a cycle
    message.message += " " + graded.reason;
  }
  message.samples_used = static_cast<std::uint32_t>(validation.samples);
  message.reduced_chi_square = validation.reduced_chi_square;
  std::transform(validation.residuals.begin(),
                 validation.residuals.end(),
                 std::back_inserter(message.residuals),
                 residualToRos);
  fillGrade(graded, message);
  return message;
}

std::vector<msg::Diagnosis> diagnosesToRos(const std::vector<Diagnosis>& diagnoses) {
  std::vector<msg::Diagnosis> messages;
  for (const Diagnosis& diagnosis : diagnoses) {
    msg::Diagnosis& message = messages.emplace_back();
    message.cause = diagnosis.cause;
    message.message = diagnosis.message;
    message.evidence = diagnosis.evidence;
  }
  return messages;
}

msg::Coverage coverageToRos(const Coverage& coverage) {
  msg::Coverage message;
  message.samples = coverage.samples;
  message.wanted = coverage.wanted;
  message.seen_well = static_cast<std::uint8_t>(coverage.isSeenWell());
  message.identified = static_cast<std::uint8_t>(coverage.identified);
  return message;
}

}  // namespace sac
