#include "spherical_actuator_calibration/ros/recording_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>

#include "ros/bag_editing.hpp"
#include "spherical_actuator_calibration/core/error.hpp"
#include "spherical_actuator_calibration/core/rotations.hpp"
#include "spherical_actuator_calibration/core/sample_builder.hpp"
#include "spherical_actuator_calibration/core/spherical_joint.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace spherical_actuator_calibration {

/// CoilCurrents as another version of this package may have had it: without header.
struct HeadlessCurrents {
  std::vector<double> current;
};

}  // namespace spherical_actuator_calibration

namespace ros {
namespace message_traits {

template <>
struct DataType<spherical_actuator_calibration::HeadlessCurrents> {
  template <typename Message>
  static const char* value(const Message& /*message*/) {
    return value();
  }
  static const char* value() { return "spherical_actuator_calibration/CoilCurrents"; }
};

template <>
struct MD5Sum<spherical_actuator_calibration::HeadlessCurrents> {
  template <typename Message>
  static const char* value(const Message& /*message*/) {
    return value();
  }
  static const char* value() { return "0123456789abcdef0123456789abcdef"; }
};

template <>
struct Definition<spherical_actuator_calibration::HeadlessCurrents> {
  template <typename Message>
  static const char* value(const Message& /*message*/) {
    return "float64[] current";
  }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<spherical_actuator_calibration::HeadlessCurrents> {
  template <typename Stream, typename Message>
  static void allInOne(Stream& stream, Message message) {
    stream.next(message.current);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization
}  // namespace ros

namespace spherical_actuator_calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr char kJoints3[] = "/actuator/joint_states";
constexpr char kOrientation[] = "/actuator/measured_orientation";
constexpr char kTorque[] = "/actuator/measured_torque";
constexpr char kCurrents[] = "/actuator/coil_currents";

Actuator unit() {
  Actuator actuator = scenarios::paperNominal();
  actuator.serial = "unit-001";
  return actuator;
}

void expectSame(const std::vector<Sample>& a, const std::vector<Sample>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].id, b[n].id);
    EXPECT_EQ(a[n].stamp, b[n].stamp);
    EXPECT_EQ(a[n].joint_position, b[n].joint_position);
    EXPECT_EQ(a[n].R_stator_rotor, b[n].R_stator_rotor);
    EXPECT_EQ(a[n].torque, b[n].torque);
    EXPECT_EQ(a[n].current, b[n].current);
  }
}

/// A recorded session, and edited copies of it.
class RecordingReader : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared = new TemporaryFolder;
    bags::recordSession(session(), unit());
  }
  static void TearDownTestSuite() {
    delete shared;
    shared = nullptr;
  }

  static std::string session() { return shared->path("session.bag"); }
  std::string path(const std::string& name) const { return folder_.path(name); }

  std::string edited(const bags::Editor& editor, const std::string& name = "edited.bag") const {
    bags::edit(session(), path(name), editor);
    return path(name);
  }

  static Recording read(const std::vector<std::string>& paths, const Actuator& nominal = unit()) {
    return readRecordings(paths, nominal, {});
  }

  static std::string readError(const std::vector<std::string>& paths,
                               const Actuator& nominal = unit()) {
    return errorMessage<DataError>([&] { read(paths, nominal); });
  }

  static void expectError(const std::string& bag,
                          const std::string& part,
                          const Actuator& nominal = unit()) {
    const std::string message = readError({bag}, nominal);
    EXPECT_NE(message.find(bag), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }

  TemporaryFolder folder_;

 private:
  static TemporaryFolder* shared;
};

TemporaryFolder* RecordingReader::shared = nullptr;

TEST_F(RecordingReader, MakesTheSamplesThatTheStreamsGive) {
  const Recording recording = read({session()});
  const Actuator actuator = unit();
  SampleBuilder builder({}, actuator.coils.size());
  JointStateReader joints({"joint_1", "joint_2", "joint_3"});
  const rosbag::Bag bag(session());
  rosbag::View view(bag);
  CurrentMeasurement current;
  for (const rosbag::MessageInstance& message : view) {
    if (message.getTopic() == kJoints3) {
      builder.add(*joints.read(*message.instantiate<sensor_msgs::JointState>()));
    } else if (message.getTopic() == kOrientation) {
      builder.add(orientationFromRos(*message.instantiate<geometry_msgs::QuaternionStamped>()));
    } else if (message.getTopic() == kTorque) {
      builder.add(torqueFromRos(*message.instantiate<geometry_msgs::Vector3Stamped>()));
    } else if (message.getTopic() == kCurrents) {
      currentFromRos(*message.instantiate<CoilCurrents>(), current);
      builder.add(current);
    }
  }
  builder.finish();
  expectSame(recording.samples, builder.takeSamples());
  EXPECT_GE(recording.samples.size(), 10U);

  // The emulated unit has the nominal parameters.
  const JointGeometry geometry = jointGeometry(actuator.joints);
  for (const Sample& sample : recording.samples) {
    ASSERT_TRUE(sample.has_orientation);
    const Eigen::Matrix3d R = rotorOrientation(geometry, sample.joint_position);
    EXPECT_LT(rotationLog(sample.R_stator_rotor * R.transpose()).norm(), 1e-3);
  }
}

TEST_F(RecordingReader, CountsEveryMessageOfTheStreams) {
  const RecordingReport report = read({session()}).report;
  EXPECT_TRUE(report.has_streams);
  EXPECT_FALSE(report.has_samples);
  const rosbag::Bag bag(session());
  rosbag::View view(bag, rosbag::TopicQuery(kTorque));
  EXPECT_EQ(report.streams.samples.torques.received, view.size());
  EXPECT_EQ(report.streams.samples.joints.droppedInAll(), 0U);
  EXPECT_TRUE(report.notes.empty());
}

TEST_F(RecordingReader, PartsOfARecordingGiveTheSamplesOfTheWhole) {
  const ros::Time middle(1'700'000'012.345);
  const std::string first = edited(
      [&](const auto& message, auto& out) {
        if (message.getTime() < middle) {
          bags::keep(message, out);
        }
      },
      "first.bag");
  const std::string second = edited(
      [&](const auto& message, auto& out) {
        if (message.getTime() >= middle) {
          bags::keep(message, out);
        }
      },
      "second.bag");
  const std::vector<Sample> whole = read({session()}).samples;
  expectSame(read({first, second}).samples, whole);
  expectSame(read({second, first}).samples, whole);
  EXPECT_LT(read({first}).samples.size(), whole.size());
}

TEST_F(RecordingReader, TopicsRecordedSideBySideGiveTheSamplesOfTheWhole) {
  const std::string robot = edited(bags::without({kOrientation}), "robot.bag");
  const std::string tracker = edited(
      [](const auto& message, auto& out) {
        if (message.getTopic() == kOrientation) {
          bags::keep(message, out);
        }
      },
      "tracker.bag");
  expectSame(read({tracker, robot}).samples, read({session()}).samples);
}

TEST_F(RecordingReader, SessionsWithTheSameClockStayApart) {
  bags::recordSession(path("other.bag"), unit(), 2);
  const std::vector<Sample> first = read({session()}).samples;
  const std::vector<Sample> second = read({path("other.bag")}).samples;
  const std::vector<Sample> both = read({session(), path("other.bag")}).samples;
  ASSERT_EQ(both.size(), first.size() + second.size());
  EXPECT_EQ(both.back().joint_position, second.back().joint_position);
  std::set<std::uint32_t> ids;
  for (const Sample& sample : both) {
    EXPECT_TRUE(ids.insert(sample.id).second) << sample.id;
  }
}

TEST_F(RecordingReader, PrefersRecordedSamples) {
  std::vector<Sample> samples = read({session()}).samples;
  samples.resize(3);
  samples[1].validation = true;
  bags::writeSamples(path("samples.bag"), unit(), bags::messagesOf(samples));
  const std::string both = edited([&, written = false](const auto& message, auto& out) mutable {
    bags::keep(message, out);
    if (!written) {
      for (const CalibrationSample& sample : bags::messagesOf(samples)) {
        out.write("/actuator/samples", message.getTime(), sample);
      }
      written = true;
    }
  });
  for (const std::string& bag : {path("samples.bag"), both}) {
    const Recording recording = read({bag});
    ASSERT_EQ(recording.samples.size(), 3U);
    EXPECT_EQ(recording.samples[0].torque, samples[0].torque);
    EXPECT_TRUE(recording.samples[1].validation);
    EXPECT_TRUE(recording.report.has_samples);
    EXPECT_FALSE(recording.report.has_streams);
  }
}

TEST_F(RecordingReader, SamplesRecordedTwiceCountOnce) {
  std::vector<Sample> samples = read({session()}).samples;
  samples.resize(3);
  bags::writeSamples(path("a.bag"), unit(), bags::messagesOf(samples));
  fs::copy_file(path("a.bag"), path("b.bag"));
  const Recording recording = read({path("a.bag"), path("b.bag")});
  EXPECT_EQ(recording.samples.size(), 3U);
  EXPECT_EQ(recording.report.samples.repeated, 3U);
}

TEST_F(RecordingReader, SamplesOfSeveralSessionsGetNumbersOfTheirOwn) {
  std::vector<Sample> samples = read({session()}).samples;
  samples.resize(3);
  bags::writeSamples(path("a.bag"), unit(), bags::messagesOf(samples));
  for (Sample& sample : samples) {
    sample.stamp += 1'000'000'000'000;
  }
  bags::writeSamples(path("b.bag"), unit(), bags::messagesOf(samples));
  const Recording recording = read({path("a.bag"), path("b.bag")});
  ASSERT_EQ(recording.samples.size(), 6U);
  EXPECT_EQ(recording.samples[5].id, 6U);
  ASSERT_EQ(recording.report.notes.size(), 1U);
  EXPECT_NE(recording.report.notes[0].find("3 samples"), std::string::npos);
}

TEST_F(RecordingReader, OrderOfTheFilesDoesNotMatter) {
  const std::vector<Sample> samples = read({session()}).samples;
  bags::writeSamples(path("a.bag"), unit(), bags::messagesOf({samples[0], samples[1]}), 1000.0);
  bags::writeSamples(path("b.bag"), unit(), bags::messagesOf({samples[2], samples[3]}), 1000.2);
  bags::writeSamples(path("c.bag"), unit(), bags::messagesOf({samples[4], samples[5]}), 2000.0);
  expectSame(read({path("c.bag"), path("a.bag"), path("b.bag")}).samples,
             read({path("a.bag"), path("b.bag"), path("c.bag")}).samples);
}

TEST_F(RecordingReader, DropsAndTellsSamplesWithNaNInAnyField) {
  const Sample good = read({session()}).samples.back();
  ASSERT_TRUE(good.has_orientation && good.has_torque);
  const std::vector<std::function<void(CalibrationSample&)>> defects = {
      [](auto& m) { m.joint_position[1] = kNaN; },
      [](auto& m) { m.joint_stddev[2] = kNaN; },
      [](auto& m) { m.orientation.x = kNaN; },
      [](auto& m) { m.orientation.w = kNaN; },
      [](auto& m) { m.orientation_stddev = kNaN; },
      [](auto& m) { m.torque.x = kNaN; },
      [](auto& m) { m.torque.z = kNaN; },
      [](auto& m) { m.torque_stddev = kNaN; },
      [](auto& m) { m.current[5] = kNaN; },
      [](auto& m) { m.duration = kNaN; },
      [](auto& m) { m.orientation.w += 0.1; },
      [](auto& m) { m.orientation_stddev = -1.0; },
      [](auto& m) { m.header.frame_id = "world"; },
      [](auto& m) { m.current.pop_back(); },
  };
  std::vector<CalibrationSample> messages = {sampleToRos(good)};
  for (const auto& spoil : defects) {
    messages.push_back(sampleToRos(good));
    messages.back().id = 1000 + static_cast<std::uint32_t>(messages.size());
    spoil(messages.back());
  }
  bags::writeSamples(path("samples.bag"), unit(), messages);
  const Recording recording = read({path("samples.bag")});
  EXPECT_EQ(recording.samples.size(), 1U);
  const RecordedSamplesReport& report = recording.report.samples;
  EXPECT_EQ(report.received, messages.size());
  EXPECT_EQ(report.invalid, defects.size());
  ASSERT_EQ(report.invalid_reasons.size(), defects.size());
  EXPECT_EQ(report.invalid_reasons[0], "Sample 1002: joint_position is not finite.");
  EXPECT_EQ(report.invalid_reasons[12],
            "Sample 1014: is in the frame \"world\", not in \"stator\".");
}

TEST_F(RecordingReader, NaNAndNonUnitQuaternionsInStreamsNeverReachASample) {
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
             bags::changing<CoilCurrents>(kCurrents, [](auto& message, std::size_t n) {
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

TEST_F(RecordingReader, ToleratesTheLeadingSlashOfFrames) {
  const std::string bag = edited(bags::changing<geometry_msgs::QuaternionStamped>(
      kOrientation, [](auto& message, std::size_t /*n*/) { message.header.frame_id = "/stator"; }));
  expectSame(read({bag}).samples, read({session()}).samples);
}

TEST_F(RecordingReader, DropsMeasurementsInAnotherFrame) {
  const std::string bag = edited(bags::changing<geometry_msgs::Vector3Stamped>(
      kTorque,
      [](auto& message, std::size_t n) { message.header.frame_id = n < 7 ? "stator" : "rotor"; }));
  EXPECT_EQ(read({bag}).report.streams.torques_in_other_frame, 7U);
}

TEST_F(RecordingReader, RefusesRecordingsWhoseMeasurementsAreAllInAnotherFrame) {
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

TEST_F(RecordingReader, FindsItsJointsAmongOthers) {
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

TEST_F(RecordingReader, RefusesRecordingsOfOtherJoints) {
  expectError(edited(bags::changing<sensor_msgs::JointState>(kJoints3,
                                                             [](auto& message, std::size_t /*n*/) {
                                                               message.name = {"a", "b", "c"};
                                                             })),
              "joint_states names the joints a b c, but the description has joint_1");
}

TEST_F(RecordingReader, RefusesRecordingsOfAnotherNumberOfCoils) {
  Actuator other = unit();
  other.coils.resize(12);
  expectError(session(), "coil_currents has 24 currents, but the description has 12 coils", other);
  bags::writeSamples(
      path("samples.bag"), unit(), bags::messagesOf({read({session()}).samples.back()}));
  expectError(
      path("samples.bag"), "samples have 24 currents, but the description has 12 coils", other);
}

TEST_F(RecordingReader, RefusesRecordingsOfAnotherUnit) {
  Actuator other = unit();
  other.serial = "unit-002";
  expectError(
      session(), "recorded with the unit unit-001, but the description is of unit-002", other);
  other = unit();
  other.name = "something";
  expectError(session(), "but the description is of something", other);
}

TEST_F(RecordingReader, NotesWhenAUnitIsNotNamed) {
  const std::string anonymous = edited(bags::without({"/actuator/parameters"}));
  ASSERT_EQ(read({anonymous}).report.notes.size(), 1U);
  EXPECT_NE(read({anonymous}).report.notes[0].find("taken as one of unit-001"), std::string::npos);
  Actuator nameless = unit();
  nameless.serial.clear();
  ASSERT_EQ(read({session()}, nameless).report.notes.size(), 1U);
  EXPECT_NE(read({session()}, nameless).report.notes[0].find("unit-001"), std::string::npos);
  EXPECT_TRUE(read({anonymous}, nameless).report.notes.empty());
}

TEST_F(RecordingReader, TellsWhichTopicIsMissingAndWhereItIs) {
  expectError(edited(bags::without({kJoints3})), "no message of /actuator/joint_states");
  expectError(edited(bags::without({kOrientation, kTorque}), "2.bag"),
              "no message of /actuator/measured_orientation nor of /actuator/measured_torque");
  RecordingOptions options;
  options.ns = "arm";
  const std::string message =
      errorMessage<DataError>([&] { readRecordings({session()}, unit(), options); });
  EXPECT_NE(message.find("/arm/joint_states; it is recorded below /actuator: choose by --ns"),
            std::string::npos)
      << message;
}

TEST_F(RecordingReader, NotesWhichStreamsAreMissing) {
  const auto notes = [this](const std::vector<std::string>& topics) {
    return read({edited(bags::without(topics))}).report.notes;
  };
  EXPECT_EQ(notes({kOrientation}).at(0),
            "No orientation is recorded: the joint cannot be calibrated.");
  EXPECT_EQ(notes({kTorque}).at(0), "No torque is recorded: poles and coils cannot be calibrated.");
  EXPECT_EQ(notes({kCurrents}).at(0),
            "No coil current is recorded: poles and coils cannot be calibrated.");
}

TEST_F(RecordingReader, TopicsMayLieBelowAnyNamespace) {
  const std::string bag = edited([](const auto& message, auto& out) {
    const std::string& topic = message.getTopic();
    out.write(
        topic.rfind("/actuator", 0) == 0 ? topic.substr(9) : topic, message.getTime(), message);
  });
  RecordingOptions options;
  options.ns = "/";
  expectSame(readRecordings({bag}, unit(), options).samples, read({session()}).samples);
}

TEST_F(RecordingReader, RefusesTopicsOfAnotherType) {
  const std::string bag = edited([](const auto& message, auto& out) {
    if (message.getTopic() == kTorque) {
      out.write(kTorque, message.getTime(), std_msgs::String());
    } else {
      bags::keep(message, out);
    }
  });
  expectError(bag, "/actuator/measured_torque is recorded as std_msgs/String");
}

TEST_F(RecordingReader, RefusesTopicsOfAnotherVersionOfTheirType) {
  const std::string bag = edited([](const auto& message, auto& out) {
    if (message.getTopic() == kCurrents) {
      out.write(kCurrents, message.getTime(), HeadlessCurrents());
    } else {
      bags::keep(message, out);
    }
  });
  expectError(bag, "/actuator/coil_currents was recorded with another version of");
}

TEST_F(RecordingReader, WithoutATorqueModelOnlyTheJointIsRead) {
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

TEST_F(RecordingReader, RefusesFilesThatAreNoRecording) {
  expectError(path("missing.bag"), "there is no such file");
  fs::create_directory(path("folder.bag"));
  expectError(path("folder.bag"), "is not a file");
  expectError(folder_.write("zero.bag", ""), "the file is empty");
  expectError(folder_.write("text.bag", "hello, this is no bag\n"), "cannot be read as a bag");
  rosbag::Bag(path("nothing.bag"), rosbag::bagmode::Write).close();
  expectError(path("nothing.bag"), "the bag holds no messages");
  EXPECT_NE(readError({session(), session()}).find("is given twice"), std::string::npos);
}

TEST_F(RecordingReader, TellsHowToRescueTruncatedRecordings) {
  const std::string whole = contentOf(session());
  for (const double share : {0.02, 0.3, 0.5, 0.9, 0.999}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    expectError(folder_.write("cut.bag", whole.substr(0, size)), "rosbag reindex");
  }
}

TEST_F(RecordingReader, TellsThatARecordingWasNotClosed) {
  rosbag::Bag bag(path("open.bag"), rosbag::bagmode::Write);
  bag.write("/actuator/measured_torque", ros::Time(1.0), geometry_msgs::Vector3Stamped());
  fs::copy_file(path("open.bag"), path("copy.bag"));
  bag.close();
  expectError(path("copy.bag"), "rosbag reindex");
}

TEST_F(RecordingReader, SurvivesDamagedBytes) {
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

TEST_F(RecordingReader, TellsItsProgress) {
  std::vector<double> shares;
  RecordingOptions options;
  options.progress = [&shares](double share) { shares.push_back(share); };
  readRecordings({session()}, unit(), options);
  ASSERT_GE(shares.size(), 3U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GT(shares[0], 0.0);
  EXPECT_LT(shares[0], 0.9);
  EXPECT_EQ(shares.back(), 1.0);
}

TEST_F(RecordingReader, DescribesWhatBecameOfARecording) {
  const std::string bag = edited(
      bags::changing<geometry_msgs::Vector3Stamped>(kTorque, [](auto& message, std::size_t n) {
        message.vector.x = n < 3 ? kNaN : message.vector.x;
        message.header.frame_id = n == 9 ? "world" : message.header.frame_id;
      }));
  std::string text;
  for (const std::string& line : describe(read({bag}).report)) {
    text += line + "\n";
  }
  EXPECT_NE(text.find("3 dropped (3 not finite)"), std::string::npos) << text;
  EXPECT_NE(text.find("1 torques in another frame dropped."), std::string::npos) << text;
  EXPECT_NE(text.find("dwells at rest gave"), std::string::npos) << text;
}

}  // namespace
}  // namespace spherical_actuator_calibration
