#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <sensor_msgs/JointState.h>
#include <spherical_actuator_calibration/CalibrationSample.h>
#include <spherical_actuator_calibration/CoilCurrents.h>

#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/Coverage.h"
#include "spherical_actuator_calibration/Diagnosis.h"
#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/calibration_record.hpp"
#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"
#include "spherical_actuator_calibration/calibration/session_progress.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"
#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

// Frames are in the header of a message and are no part of the core's types: whoever converts a
// message checks its frame, or fills it in.

Eigen::Vector3d vectorFromRos(const geometry_msgs::Vector3& message);
geometry_msgs::Vector3 vectorToRos(const Eigen::Vector3d& vector);
geometry_msgs::Point pointToRos(const Eigen::Vector3d& point);

/// Component by component, not normalised.
Eigen::Quaterniond quaternionFromRos(const geometry_msgs::Quaternion& message);
geometry_msgs::Quaternion quaternionToRos(const Eigen::Quaterniond& quaternion);

/// Not checked: the core drops and counts what is not finite or no unit quaternion.
OrientationMeasurement orientationFromRos(const geometry_msgs::QuaternionStamped& message);
TorqueMeasurement torqueFromRos(const geometry_msgs::Vector3Stamped& message);
/// Into a measurement whose storage is reused.
void currentFromRos(const msg::CoilCurrents& message, CurrentMeasurement& measurement);

/// Picks the joints of one actuator out of joint states, by name. Remembers where they were, so
/// that names are searched only when their order changes.
class JointStateReader {
 public:
  explicit JointStateReader(std::array<std::string, kJoints> names) : names_(std::move(names)) {}

  /// Nothing when a joint or its position is missing. Other joints are ignored.
  std::optional<JointMeasurement> read(const sensor_msgs::JointState& message);

 private:
  bool locate(const sensor_msgs::JointState& message);

  std::array<std::string, kJoints> names_;
  std::array<std::size_t, kJoints> places_ = {0, 1, 2};
};

/// Throws DataError, naming the sample, when it carries an orientation that is no unit quaternion
/// (1e-3, then normalised). Everything else is for validate(Sample).
Sample sampleFromRos(const msg::CalibrationSample& message);
/// frame_id stays empty.
msg::CalibrationSample sampleToRos(const Sample& sample);

/// Name, serial number and all parameters of an actuator; header, revision and source stay empty.
/// What has no standard deviation has an infinite one, as everything has by default.
msg::ActuatorParameters parametersToRos(const Actuator& actuator,
                                        const ParameterStddevs& stddevs = {});

/// `design` with everything identified that a message holds: geometry, gains, corrections, torque
/// law, orientation map. Nothing when the message is of another actuator or unit, has other numbers
/// of poles or coils, another polarity or kind of rotor, or its law or map is none.
std::optional<Actuator> actuatorFromRos(const msg::ActuatorParameters& message,
                                        const Actuator& design);

/// The standard deviation of what is not observable is infinite.
msg::ParameterEstimate estimateToRos(const ParameterEstimate& estimate);

/// `graded`: what is in force after the cycle. The header stays empty. The standard deviation of
/// what is not observable is infinite.
msg::CalibrationReport reportToRos(const CycleReport& report, const GradedCalibration& graded);

/// A validation in the form of a report: cycle "validate", residuals of the held-out samples.
/// `success` tells whether they agree. The header stays empty.
msg::CalibrationReport validationToRos(const HeldOutValidation& validation,
                                       const GradedCalibration& graded);

/// In the same order.
std::vector<msg::Diagnosis> diagnosesToRos(const std::vector<Diagnosis>& diagnoses);

/// Field by field.
msg::Coverage coverageToRos(const Coverage& coverage);

}  // namespace sac
