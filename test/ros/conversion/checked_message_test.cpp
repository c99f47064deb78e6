#include "spherical_actuator_calibration/ros/conversion/checked_message.hpp"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>
#include <spherical_actuator_calibration/CoilCurrents.h>
#include <tf2_msgs/TFMessage.h>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// As roscpp sends it.
template <typename Message>
Bytes bytesOf(const Message& message) {
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <typename Message>
Checked<Message> read(const Bytes& bytes) {
  Checked<Message> checked;
  // As roscpp reads what arrives.
  Bytes copy = bytes;
  ros::serialization::IStream stream(copy.data(), static_cast<std::uint32_t>(copy.size()));
  ros::serialization::deserialize(stream, checked);
  return checked;
}

sensor_msgs::JointState joints() {
  sensor_msgs::JointState message;
  message.header.seq = 7;
  message.header.stamp = ros::Time(4294967295, 999999999);
  message.header.frame_id = "stator";
  message.name = {"joint_1", "", "joint_3"};
  message.position = {0.1, -0.0, 1e300};
  message.effort = {1.0};
  return message;
}

tf2_msgs::TFMessage transforms() {
  tf2_msgs::TFMessage message;
  message.transforms.resize(2);
  message.transforms[1].child_frame_id = "rotor";
  message.transforms[1].transform.rotation.w = 1.0;
  return message;
}

TEST(CheckedMessage, GivesWhatWasSent) {
  const auto checked = read<sensor_msgs::JointState>(bytesOf(joints()));
  EXPECT_EQ(checked.defect, "");
  EXPECT_EQ(checked.message, joints());
  EXPECT_EQ(read<tf2_msgs::TFMessage>(bytesOf(transforms())).message, transforms());
  const sensor_msgs::JointState empty;
  EXPECT_EQ(read<sensor_msgs::JointState>(bytesOf(empty)).message, empty);
}

TEST(CheckedMessage, IsTheSameTypeForOtherNodes) {
  using Message = msg::CoilCurrents;
  EXPECT_STREQ(ros::message_traits::md5sum<Checked<Message>>(),
               ros::message_traits::md5sum<Message>());
  EXPECT_STREQ(ros::message_traits::datatype<Checked<Message>>(),
               ros::message_traits::datatype<Message>());
}

TEST(CheckedMessage, RefusesEveryMessageThatIsCut) {
  const Bytes whole = bytesOf(joints());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const auto checked = read<sensor_msgs::JointState>(cut);
    EXPECT_NE(checked.defect, "") << size;
    EXPECT_TRUE(checked.message.name.empty());
  }
}

// roscpp's own reading would take 34 GB for these 213 bytes.
TEST(CheckedMessage, BelievesNoLength) {
  msg::CoilCurrents message;
  message.current.assign(24, 0.5);
  Bytes bytes = bytesOf(message);
  const std::size_t length = bytes.size() - 24 * sizeof(double) - 4;
  for (const std::uint8_t high : std::array<std::uint8_t, 3>{0x01, 0x10, 0xFF}) {
    bytes[length + 3] = high;
    const auto checked = read<msg::CoilCurrents>(bytes);
    EXPECT_EQ(checked.defect, "it says that it holds more than its bytes");
    EXPECT_EQ(checked.message.current.capacity(), 0U);
  }
  Bytes transform_bytes = bytesOf(transforms());
  transform_bytes[2] = 1;  // 65538 transforms, one after the other until the bytes end
  EXPECT_NE(read<tf2_msgs::TFMessage>(transform_bytes).defect, "");
}

TEST(CheckedMessage, RefusesWhatIsTooLong) {
  constexpr std::size_t kLargest = kLargestMessage<sensor_msgs::JointState>;
  sensor_msgs::JointState message;
  message.header.frame_id.assign(kLargest, 'x');
  EXPECT_NE(read<sensor_msgs::JointState>(bytesOf(message)).defect.find("are the most that is"),
            std::string::npos);
  message.header.frame_id.resize(kLargest - 100);
  EXPECT_EQ(read<sensor_msgs::JointState>(bytesOf(message)).defect, "");
}

// A queue of ten thousand holds no more than a node may have.
TEST(CheckedMessage, OfStreamsAreShort) {
  constexpr std::size_t kQueue = 10000;
  constexpr std::size_t kMost = std::size_t{200} << 20U;
  EXPECT_LT(kQueue * kLargestMessage<sensor_msgs::JointState>, kMost);
  EXPECT_LT(kQueue * kLargestMessage<geometry_msgs::QuaternionStamped>, kMost);
  EXPECT_LT(kQueue * kLargestMessage<geometry_msgs::Vector3Stamped>, kMost);
  // Of a thousand coils, and of a hundred joints.
  msg::CoilCurrents currents;
  currents.current.resize(1000);
  EXPECT_EQ(read<msg::CoilCurrents>(bytesOf(currents)).defect, "");
  sensor_msgs::JointState joints;
  joints.name.assign(100, "a_joint_with_a_rather_long_name");
  joints.position.resize(100);
  joints.velocity.resize(100);
  joints.effort.resize(100);
  EXPECT_EQ(read<sensor_msgs::JointState>(bytesOf(joints)).defect, "");
}

}  // namespace
}  // namespace sac
