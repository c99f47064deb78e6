#include <array>
#include <string>
#include <vector>

#include <geometry_msgs/Vector3.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <spherical_actuator_calibration/CalibrationSample.h>
#include <spherical_actuator_calibration/CoilCurrents.h>
#include <std_msgs/Header.h>

#include "support/recording_case.hpp"

namespace sac {

/// ActuatorParameters of release 0.1, of an actuator without poles and coils.
struct ParametersOfRelease01 {
  struct Joint {
    geometry_msgs::Vector3 axis;
    double offset = 0.0;
  };
  std_msgs::Header header;
  std::string actuator;
  std::string serial;
  std::uint32_t revision = 0;
  std::string source = "nominal";
  std::array<Joint, 3> joints;
  std::vector<double> poles;
  std::vector<double> coils;
};

}  // namespace sac

namespace ros {
namespace message_traits {

template <>
struct DataType<sac::ParametersOfRelease01> {
  static const char* value(const sac::ParametersOfRelease01& /*message*/) { return value(); }
  static const char* value() { return "spherical_actuator_calibration/ActuatorParameters"; }
};

template <>
struct MD5Sum<sac::ParametersOfRelease01> {
  static const char* value(const sac::ParametersOfRelease01& /*message*/) { return value(); }
  static const char* value() { return "2c81fe26a97f0081d4850ee6f2b0cbaa"; }
};

template <>
struct Definition<sac::ParametersOfRelease01> {
  static const char* value(const sac::ParametersOfRelease01& /*message*/) { return "of 0.1"; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<sac::ParametersOfRelease01> {
  template <typename Stream, typename Message>
  static void allInOne(Stream& stream, Message message) {
    stream.next(message.header);
    stream.next(message.actuator);
    stream.next(message.serial);
    stream.next(message.revision);
    stream.next(message.source);
    for (auto& joint : message.joints) {
      stream.next(joint.axis);
      stream.next(joint.offset);
    }
    stream.next(message.poles);
    stream.next(message.coils);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization
}  // namespace ros

namespace sac {
namespace {

class EarlierRelease : public RecordingCase {
 protected:
  /// The session as release 0.1 recorded it, of one unit.
  std::string recordingOf(const std::string& serial) const {
    return edited([&](const auto& message, auto& out) {
      if (message.getTopic() != "/actuator/parameters") {
        return bags::keep(message, out);
      }
      ParametersOfRelease01 parameters;
      parameters.actuator = unit().name;
      parameters.serial = serial;
      out.write(message.getTopic(), message.getTime(), parameters);
    });
  }
};

TEST_F(EarlierRelease, ItsRecordingsAreRead) {
  const Recording recording = read({recordingOf("unit-001")});
  expectSame(recording.samples, read({session()}).samples);
  EXPECT_TRUE(recording.report.notes.empty());
}

TEST_F(EarlierRelease, ItsRecordingsTellTheirUnit) {
  expectError(recordingOf("unit-002"), "recorded with the unit unit-002");
}

// Recordings hold these types: whoever changes them cuts off all recordings made so far, or reads
// the earlier ones, too, as those of kEarlierSampleMd5 in recorded_topics.hpp.
TEST(MessageTypes, OfRecordingsChangeOnlyWithCare) {
  using ros::message_traits::md5sum;
  EXPECT_STREQ(md5sum<msg::CalibrationSample>(), "ce6e2763d2e93b4ca430812288ab43e6");
  EXPECT_STREQ(md5sum<msg::CoilCurrents>(), "d23a3e73b757f5a536511eb28393bf6c");
}

}  // namespace
}  // namespace sac
