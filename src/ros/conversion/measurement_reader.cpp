#include "spherical_actuator_calibration/ros/conversion/measurement_reader.hpp"

#include <optional>
#include <utility>

#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

namespace sac {

MeasurementReader::MeasurementReader(const Actuator& nominal, MeasurementFrames frames)
    : frames_(std::move(frames)), joint_reader_(jointNames(nominal)) {}

const JointMeasurement* MeasurementReader::read(const sensor_msgs::JointState& message) {
  const std::optional<JointMeasurement> joints = joint_reader_.read(message);
  if (!joints) {
    refusal_ = "it lacks a joint of the description, or its position";
    return nullptr;
  }
  joints_ = *joints;
  return &joints_;
}

const OrientationMeasurement* MeasurementReader::read(
    const geometry_msgs::QuaternionStamped& message) {
  if (!isIn(frames_.stator, message.header.frame_id)) {
    return nullptr;
  }
  orientation_ = orientationFromRos(message);
  return &orientation_;
}

const TorqueMeasurement* MeasurementReader::read(const geometry_msgs::Vector3Stamped& message) {
  if (!isIn(frames_.rotor, message.header.frame_id)) {
    return nullptr;
  }
  torque_ = torqueFromRos(message);
  return &torque_;
}

const CurrentMeasurement* MeasurementReader::read(const msg::CoilCurrents& message) {
  currentFromRos(message, current_);
  return &current_;
}

const CurrentCommand& MeasurementReader::readCommand(const msg::CoilCurrents& message) {
  command_.stamp = stampFromRos(message.header.stamp);
  command_.current = Eigen::Map<const Eigen::VectorXd>(
      message.current.data(), static_cast<Eigen::Index>(message.current.size()));
  return command_;
}

bool MeasurementReader::isIn(const std::string& frame, const std::string& frame_id) {
  if (isFrame(frame_id, frame)) {
    return true;
  }
  refusal_ = "it " + otherFrame(frame_id, frame);
  return false;
}

}  // namespace sac
