#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "support/recording_case.hpp"

namespace sac {

/// CoilCurrents as another version of this package may have had it: without header.
struct HeadlessCurrents {
  std::vector<double> current;
};

}  // namespace sac

namespace ros {
namespace message_traits {

template <>
struct DataType<sac::HeadlessCurrents> {
  template <typename Message>
  static const char* value(const Message& /*message*/) {
    return value();
  }
  static const char* value() { return "spherical_actuator_calibration/CoilCurrents"; }
};

template <>
struct MD5Sum<sac::HeadlessCurrents> {
  template <typename Message>
  static const char* value(const Message& /*message*/) {
    return value();
  }
  static const char* value() { return "0123456789abcdef0123456789abcdef"; }
};

template <>
struct Definition<sac::HeadlessCurrents> {
  template <typename Message>
  static const char* value(const Message& /*message*/) {
    return "float64[] current";
  }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<sac::HeadlessCurrents> {
  template <typename Stream, typename Message>
  static void allInOne(Stream& stream, Message message) {
    stream.next(message.current);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization
}  // namespace ros
namespace sac {
namespace {

namespace fs = std::filesystem;

/// Recordings that hold something else than they should.
class RecordingDefects : public RecordingCase {};

TEST_F(RecordingDefects, NaNAndNonUnitQuaternionsInStreamsNeverReachASample) {
  // Every tenth message of each stream is spoilt, its fields in turn.
  const std::string joints =
      edited(bags::changing<sensor_msgs::JointState>(kJoints3,
                                                     [](auto& message, std::size_t n) {
                                                       if (n % 10 == 0) {
                                                         message.position[n / 10 % 3] = kNaN;
                                                       }
                                                     }),
             "1.bag");
  bags::edit(joints,
             path("2.bag"),
             bags::changing<geometry_msgs::QuaternionStamped>(
                 kOrientation, [](auto& message, std::size_t n) {
                   double* fields[] = {&message.quaternion.x,
                                       &message.quaternion.y,
                                       &message.quaternion.z,
                                       &message.quaternion.w};
                   if (n % 10 == 0) {
                     *fields[n / 10 % 4] = n % 20 == 0 ? kNaN : 3.0;
                   }
                 }));
  bags::edit(
      path("2.bag"),
      path("3.bag"),
      bags::changing<geometry_msgs::Vector3Stamped>(kTorque, [](auto& message, std::size_t n) {
        double* fields[] = {&message.vector.x, &message.vector.y, &message.vector.z};
        if (n % 10 == 0) {
          *fields[n / 10 % 3] = kNaN;
        }
      }));
  bags::edit(path("3.bag"),
             path("4.bag"),
             bags::changing<msg::CoilCurrents>(kCurrents, [](auto& message, std::size_t n) {
               if (n % 10 == 0) {
                 message.current[n / 10 % 24] = kNaN;
               }
             }));
  const Recording recording = read({path("4.bag")});
  const SampleBuilderReport& report = recording.report.streams.samples;
  for (const StreamStatistics* stream :
       {&report.joints, &report.orientations, &report.torques, &report.currents}) {
    EXPECT_NEAR(static_cast<double>(stream->droppedInAll()),
                static_cast<double>(stream->received) / 10.0,
                1.0);
    EXPECT_GT(stream->droppedFor(DropReason::kNotFinite), 0U);
  }
  EXPECT_GT(report.orientations.droppedFor(DropReason::kNotUnit), 0U);
  const std::vector<Sample> clean = read({session()}).samples;
  ASSERT_EQ(recording.samples.size(), clean.size());
  for (std::size_t n = 0; n < clean.size(); ++n) {
    EXPECT_NO_THROW(validate(recording.samples[n], 24));
    EXPECT_LT((recording.samples[n].torque - clean[n].torque).norm(), 1e-3);
    EXPECT_LT((recording.samples[n].R_stator_rotor - clean[n].R_stator_rotor).norm(), 1e-3);
  }
}

TEST_F(RecordingDefects, ToleratesTheLeadingSlashOfFrames) {
  const std::string bag = edited(bags::changing<geometry_msgs::QuaternionStamped>(
      kOrientation, [](auto& message, std::size_t /*n*/) { message.header.frame_id = "/stator"; }));
  expectSame(read({bag}).samples, read({session()}).samples);
}

TEST_F(RecordingDefects, DropsMeasurementsInAnotherFrame) {
  const std::string bag = edited(bags::changing<geometry_msgs::Vector3Stamped>(
      kTorque,
      [](auto& message, std::size_t n) { message.header.frame_id = n < 7 ? "stator" : "rotor"; }));
  EXPECT_EQ(read({bag}).report.streams.torques_in_other_frame, 7U);
}

TEST_F(RecordingDefects, RefusesRecordingsWhoseMeasurementsAreAllInAnotherFrame) {
  expectError(edited(bags::changing<geometry_msgs::QuaternionStamped>(
                  kOrientation,
                  [](auto& message, std::size_t /*n*/) { message.header.frame_id = "tracker"; })),
              "measured_orientation is in the frame \"tracker\", not in \"stator\"");
  expectError(
      edited(bags::changing<geometry_msgs::Vector3Stamped>(
                 kTorque, [](auto& message, std::size_t /*n*/) { message.header.frame_id = ""; }),
             "2.bag"),
      "measured_torque is in the frame \"\", not in \"rotor\"");
}

TEST_F(RecordingDefects, FindsItsJointsAmongOthers) {
  const std::string bag =
      edited(bags::changing<sensor_msgs::JointState>(kJoints3, [](auto& message, std::size_t n) {
        message.name = {"gripper", "joint_3", "joint_1", "joint_2"};
        message.position = {9.0, message.position[2], message.position[0], message.position[1]};
        if (n == 5) {
          message.name.resize(2);
          message.position.resize(2);
        }
      }));
  const Recording recording = read({bag});
  EXPECT_EQ(recording.report.streams.incomplete_joint_states, 1U);
  EXPECT_EQ(recording.samples.size(), read({session()}).samples.size());
}

TEST_F(RecordingDefects, RefusesRecordingsOfOtherJoints) {
  expectError(edited(bags::changing<sensor_msgs::JointState>(kJoints3,
                                                             [](auto& message, std::size_t /*n*/) {
                                                               message.name = {"a", "b", "c"};
                                                             })),
              "joint_states names the joints a b c, but the description has joint_1");
}

TEST_F(RecordingDefects, RefusesRecordingsOfAnotherNumberOfCoils) {
  Actuator other = unit();
  other.coils.resize(12);
  expectError(session(), "coil_currents has 24 currents, but the description has 12 coils", other);
  bags::writeSamples(
      path("samples.bag"), unit(), bags::messagesOf({read({session()}).samples.back()}));
  expectError(
      path("samples.bag"), "samples have 24 currents, but the description has 12 coils", other);
}

TEST_F(RecordingDefects, RefusesRecordingsOfAnotherUnit) {
  Actuator other = unit();
  other.serial = "unit-002";
  expectError(
      session(), "recorded with the unit unit-001, but the description is of unit-002", other);
  other = unit();
  other.name = "something";
  expectError(session(), "but the description is of something", other);
}

TEST_F(RecordingDefects, NotesWhenAUnitIsNotNamed) {
  const std::string anonymous = edited(bags::without({"/actuator/parameters"}));
  ASSERT_EQ(read({anonymous}).report.notes.size(), 1U);
  EXPECT_NE(read({anonymous}).report.notes[0].find("taken as one of unit-001"), std::string::npos);
  Actuator nameless = unit();
  nameless.serial.clear();
  ASSERT_EQ(read({session()}, nameless).report.notes.size(), 1U);
  EXPECT_NE(read({session()}, nameless).report.notes[0].find("unit-001"), std::string::npos);
  EXPECT_TRUE(read({anonymous}, nameless).report.notes.empty());
}

TEST_F(RecordingDefects, TellsWhichTopicIsMissingAndWhereItIs) {
  expectError(edited(bags::without({kJoints3})), "no message of /actuator/joint_states");
  expectError(edited(bags::without({kOrientation, kTorque}), "2.bag"),
              "no message of /actuator/measured_orientation nor of /actuator/measured_torque");
  // Momentum tells much without them.
  RecordingOptions motion;
  motion.motion = MotionUse::kAlways;
  const std::string joints_and_currents = edited(bags::without({kOrientation, kTorque}), "3.bag");
  EXPECT_EQ(readRecordings({joints_and_currents}, unit(), motion).motion.spans.size(), 1U);
  RecordingOptions options;
  options.ns = "arm";
  const std::string message =
      errorMessage<DataError>([&] { readRecordings({session()}, unit(), options); });
  EXPECT_NE(message.find("/arm/joint_states; it is recorded below /actuator: choose by --ns"),
            std::string::npos)
      << message;
}

TEST_F(RecordingDefects, NotesWhichStreamsAreMissing) {
  const auto missing = [this](const std::vector<std::string>& topics) {
    return read({edited(bags::without(topics))}).report.missing;
  };
  EXPECT_EQ(missing({kOrientation}).at(0),
            "No orientation is recorded: the joint cannot be calibrated.");
  EXPECT_EQ(missing({kTorque}).at(0),
            "No torque is recorded: poles and coils cannot be calibrated.");
  EXPECT_EQ(missing({kCurrents}).at(0),
            "No coil current is recorded: poles and coils cannot be calibrated.");
}

TEST_F(RecordingDefects, TopicsMayLieBelowAnyNamespace) {
  const std::string bag = edited([](const auto& message, auto& out) {
    const std::string& topic = message.getTopic();
    out.write(
        topic.rfind("/actuator", 0) == 0 ? topic.substr(9) : topic, message.getTime(), message);
  });
  RecordingOptions options;
  options.ns = "/";
  expectSame(readRecordings({bag}, unit(), options).samples, read({session()}).samples);
}

TEST_F(RecordingDefects, RefusesTopicsOfAnotherType) {
  const std::string bag = edited([](const auto& message, auto& out) {
    if (message.getTopic() == kTorque) {
      out.write(kTorque, message.getTime(), std_msgs::String());
    } else {
      bags::keep(message, out);
    }
  });
  expectError(bag, "/actuator/measured_torque is recorded as std_msgs/String");
}

TEST_F(RecordingDefects, RefusesTopicsOfAnotherVersionOfTheirType) {
  const std::string bag = edited([](const auto& message, auto& out) {
    if (message.getTopic() == kCurrents) {
      out.write(kCurrents, message.getTime(), HeadlessCurrents());
    } else {
      bags::keep(message, out);
    }
  });
  expectError(bag, "/actuator/coil_currents was recorded with another version of");
}

TEST_F(RecordingDefects, WithoutATorqueModelOnlyTheJointIsRead) {
  Actuator joint_only = unit();
  joint_only.poles.clear();
  joint_only.coils.clear();
  joint_only.torque_curve.reset();
  const Recording recording = read({session()}, joint_only);
  EXPECT_EQ(recording.report.streams.samples.torques.received, 0U);
  ASSERT_FALSE(recording.samples.empty());
  for (const Sample& sample : recording.samples) {
    EXPECT_TRUE(sample.has_orientation);
    EXPECT_FALSE(sample.has_torque);
  }
  bags::writeSamples(
      path("samples.bag"), unit(), bags::messagesOf({read({session()}).samples.back()}));
  EXPECT_FALSE(read({path("samples.bag")}, joint_only).samples.at(0).has_torque);
}

TEST_F(RecordingDefects, RefusesFilesThatAreNoRecording) {
  expectError(path("missing.bag"), "there is no such file");
  fs::create_directory(path("folder.bag"));
  expectError(path("folder.bag"), "is not a file");
  expectError(folder_.write("zero.bag", ""), "the file is empty");
  expectError(folder_.write("text.bag", "hello, this is no bag\n"), "cannot be read as a bag");
  rosbag::Bag(path("nothing.bag"), rosbag::bagmode::Write).close();
  expectError(path("nothing.bag"), "the bag holds no messages");
  EXPECT_NE(readError({session(), session()}).find("is given twice"), std::string::npos);
}

TEST_F(RecordingDefects, TellsHowToRescueTruncatedRecordings) {
  const std::string whole = contentOf(session());
  for (const double share : {0.02, 0.3, 0.5, 0.9, 0.999}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    expectError(folder_.write("cut.bag", whole.substr(0, size)), "rosbag reindex");
  }
}

TEST_F(RecordingDefects, TellsThatARecordingWasNotClosed) {
  rosbag::Bag bag(path("open.bag"), rosbag::bagmode::Write);
  bag.write("/actuator/measured_torque", ros::Time(1.0), geometry_msgs::Vector3Stamped());
  fs::copy_file(path("open.bag"), path("copy.bag"));
  bag.close();
  expectError(path("copy.bag"), "rosbag reindex");
}

TEST_F(RecordingDefects, SurvivesDamagedBytes) {
  const std::string whole = contentOf(session());
  std::mt19937 generator(7);
  std::uniform_int_distribution<std::size_t> place(0, whole.size() - 1);
  int refused = 0;
  for (int trial = 0; trial < 20; ++trial) {
    std::string damaged = whole;
    for (int n = 0; n < 20; ++n) {
      damaged[place(generator)] ^= static_cast<char>(0x5a);
    }
    const std::string bag = folder_.write("damaged.bag", damaged);
    const std::string message = readError({bag});
    if (message != "no exception") {
      ++refused;
      EXPECT_NE(message.find(bag), std::string::npos) << message;
    }
  }
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace sac
