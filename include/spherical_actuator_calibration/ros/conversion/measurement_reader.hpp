#pragma once

#include <string>

#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <sensor_msgs/JointState.h>
#include <spherical_actuator_calibration/CoilCurrents.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {

/// Turns the messages of the four measured streams of one actuator into measurements, live and of
/// recordings alike. Joint names and frames are judged here; what is wrong with the values (not
/// finite, no unit quaternion, another number of currents) or with the stamps is for the
/// SampleBuilder to judge. Not thread-safe.
class MeasurementReader {
 public:
  /// `nominal`: whose joints are read. `frames`: those that orientations and torques must be in.
  MeasurementReader(const Actuator& nominal, MeasurementFrames frames);

  /// The measurement of a message, valid until the next one of its kind is read. Null when the
  /// message is refused: refusal() tells why.
  const JointMeasurement* read(const sensor_msgs::JointState& message);
  const OrientationMeasurement* read(const geometry_msgs::QuaternionStamped& message);
  const TorqueMeasurement* read(const geometry_msgs::Vector3Stamped& message);
  const CurrentMeasurement* read(const msg::CoilCurrents& message);
  /// Of a command, which is no measurement; valid until the next one is read.
  const CurrentCommand& readCommand(const msg::CoilCurrents& message);

  /// What is wrong with the last message that was refused: "it …", without a full stop.
  const std::string& refusal() const { return refusal_; }

 private:
  bool isIn(const std::string& frame, const std::string& frame_id);

  MeasurementFrames frames_;
  JointStateReader joint_reader_;
  std::string refusal_;
  // Storage of the measurements, reused.
  JointMeasurement joints_;
  OrientationMeasurement orientation_;
  TorqueMeasurement torque_;
  CurrentMeasurement current_;
  CurrentCommand command_;
};

}  // namespace sac
