#include "spherical_actuator_calibration/ros/conversion/measurement_reader.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace sac {
namespace {

MeasurementFrames labFrames() {
  MeasurementFrames frames;
  frames.stator = "lab_stator";
  frames.rotor = "lab_rotor";
  return frames;
}

MeasurementReader reader() {
  return {scenarios::paperNominal(), labFrames()};
}

sensor_msgs::JointState jointState() {
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time(12, 345);
  for (const JointAxis& joint : scenarios::paperNominal().joints) {
    message.name.push_back(joint.name);
  }
  message.position = {0.1, -0.2, 0.3};
  return message;
}

TEST(MeasurementReader, ReadsTheFourStreams) {
  MeasurementReader streams = reader();
  const JointMeasurement* joints = streams.read(jointState());
  ASSERT_NE(joints, nullptr);
  EXPECT_EQ(joints->stamp, 12'000'000'345);
  EXPECT_EQ(joints->position, Eigen::Vector3d(0.1, -0.2, 0.3));

  geometry_msgs::QuaternionStamped orientation;
  orientation.header.frame_id = "lab_stator";
  orientation.quaternion.w = 1.0;
  ASSERT_NE(streams.read(orientation), nullptr);
  EXPECT_EQ(streams.read(orientation)->q_stator_rotor.w(), 1.0);

  geometry_msgs::Vector3Stamped torque;
  torque.header.frame_id = "/lab_rotor";  // as in old recordings
  torque.vector.z = 0.5;
  ASSERT_NE(streams.read(torque), nullptr);
  EXPECT_EQ(streams.read(torque)->torque, Eigen::Vector3d(0.0, 0.0, 0.5));

  msg::CoilCurrents currents;
  currents.current = {1.0, 2.0};
  EXPECT_EQ(streams.read(currents)->current, Eigen::Vector2d(1.0, 2.0));
}

TEST(MeasurementReader, RefusesMessagesThatLackAJoint) {
  MeasurementReader streams = reader();
  sensor_msgs::JointState message = jointState();
  message.name[1] = "elbow";
  EXPECT_EQ(streams.read(message), nullptr);
  EXPECT_EQ(streams.refusal(), "it lacks a joint of the description, or its position");
  message = jointState();
  message.position.pop_back();
  EXPECT_EQ(streams.read(message), nullptr);
}

TEST(MeasurementReader, RefusesMessagesInOtherFrames) {
  MeasurementReader streams = reader();
  geometry_msgs::QuaternionStamped orientation;
  orientation.header.frame_id = "world";
  EXPECT_EQ(streams.read(orientation), nullptr);
  EXPECT_EQ(streams.refusal(), "it is in the frame \"world\", not in \"lab_stator\"");
  geometry_msgs::Vector3Stamped torque;
  torque.header.frame_id = "lab_stator";
  EXPECT_EQ(streams.read(torque), nullptr);
  EXPECT_EQ(streams.refusal(), "it is in the frame \"lab_stator\", not in \"lab_rotor\"");
}

TEST(MeasurementReader, LeavesTheValuesToTheSampleBuilder) {
  MeasurementReader streams = reader();
  sensor_msgs::JointState message = jointState();
  message.position[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(streams.read(message), nullptr);
}

}  // namespace
}  // namespace sac
