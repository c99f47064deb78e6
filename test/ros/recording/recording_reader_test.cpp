#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "support/recording_case.hpp"

namespace sac {

/// A sample as releases before 0.2 recorded it: without the last three fields.
struct EarlierSample {
  msg::CalibrationSample sample;
};
constexpr std::uint32_t kLaterBytes = 8 + 3 * 8 + 8;

}  // namespace sac

namespace ros {
namespace message_traits {

template <>
struct DataType<sac::EarlierSample> : DataType<sac::msg::CalibrationSample> {
  static const char* value(const sac::EarlierSample& /*message*/) {
    return DataType<sac::msg::CalibrationSample>::value();
  }
};

template <>
struct MD5Sum<sac::EarlierSample> {
  static const char* value(const sac::EarlierSample& /*message*/) { return value(); }
  static const char* value() { return "98178712bd5d9155a3f4f20d78530a4b"; }
};

template <>
struct Definition<sac::EarlierSample> {
  static const char* value(const sac::EarlierSample& /*message*/) { return "as it was"; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<sac::EarlierSample> {
  template <typename Stream>
  static void write(Stream& stream, const sac::EarlierSample& message) {
    std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message.sample));
    OStream whole(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    serialize(whole, message.sample);
    const std::uint32_t size = serializedLength(message);
    std::copy_n(bytes.data(), size, stream.advance(size));
  }
  static std::uint32_t serializedLength(const sac::EarlierSample& message) {
    return ros::serialization::serializationLength(message.sample) - sac::kLaterBytes;
  }
};

}  // namespace serialization
}  // namespace ros

namespace sac {
namespace {

namespace fs = std::filesystem;

class RecordingReader : public RecordingCase {};

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
      currentFromRos(*message.instantiate<msg::CoilCurrents>(), current);
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
  EXPECT_TRUE(report.missing.empty());
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
      for (const msg::CalibrationSample& sample : bags::messagesOf(samples)) {
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

TEST_F(RecordingReader, ReadsSamplesOfEarlierReleases) {
  const std::vector<Sample> samples = read({session()}).samples;
  ASSERT_NE(samples.front().dwell, 0);
  {
    rosbag::Bag bag(path("earlier.bag"), rosbag::bagmode::Write);
    for (const msg::CalibrationSample& sample : bags::messagesOf(samples)) {
      bag.write("/actuator/samples", ros::Time(1000.0), EarlierSample{sample});
    }
  }
  bags::writeSamples(path("present.bag"), unit(), bags::messagesOf(samples));
  const std::vector<Sample> read_back = read({path("earlier.bag")}).samples;
  expectSame(read_back, read({path("present.bag")}).samples);
  for (const Sample& sample : read_back) {
    EXPECT_EQ(sample.dwell, 0);
    EXPECT_EQ(sample.torque_shared_stddev, 0.0);
  }
}

TEST_F(RecordingReader, TakesSamplesOrStreamsAsAsked) {
  const std::vector<Sample> from_streams = read({session()}).samples;
  Sample taken = from_streams[2];
  taken.id = 7;
  taken.torque.setConstant(1.0);
  const std::string both = edited([&, written = false](const auto& message, auto& out) mutable {
    bags::keep(message, out);
    if (!written) {
      out.write("/actuator/samples", message.getTime(), sampleToRos(taken));
      written = true;
    }
  });
  RecordingOptions options;
  options.source = SampleSource::kDwells;
  const Recording dwells = readRecordings({both}, unit(), options);
  expectSame(dwells.samples, from_streams);
  EXPECT_FALSE(dwells.report.has_samples);

  options.source = SampleSource::kStreams;
  const Recording streams = readRecordings({both}, unit(), options);
  taken.torque = from_streams[2].torque;
  expectSame(streams.samples, {taken});
  EXPECT_FALSE(streams.report.has_samples);

  options.source = SampleSource::kSamples;
  EXPECT_EQ(readRecordings({both}, unit(), options).samples.size(), 1U);
  const std::string error =
      errorMessage<DataError>([&] { readRecordings({session()}, unit(), options); });
  EXPECT_NE(error.find("/actuator/samples was not recorded"), std::string::npos) << error;
}

TEST_F(RecordingReader, MakesEveryRestASampleWhereThoseRecordedTellNone) {
  const std::vector<Sample> from_streams = read({session()}).samples;
  const std::string both = edited([&, written = false](const auto& message, auto& out) mutable {
    bags::keep(message, out);
    if (!written) {
      Sample taken = from_streams.front();
      taken.dwell = 0;
      out.write("/actuator/samples", message.getTime(), sampleToRos(taken));
      written = true;
    }
  });
  RecordingOptions options;
  options.source = SampleSource::kStreams;
  const Recording streams = readRecordings({both}, unit(), options);
  expectSame(streams.samples, from_streams);
  EXPECT_NE(streams.report.notes.front().find("do not tell which rest"), std::string::npos);
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
  const std::vector<std::function<void(msg::CalibrationSample&)>> defects = {
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
  std::vector<msg::CalibrationSample> messages = {sampleToRos(good)};
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
}  // namespace sac
