#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "streams/coils_in_turn.hpp"
#include "support/synthetic_streams.hpp"

namespace sac {
namespace {

/// Two poses, each with rest, coil 2 and coil 3; at the second one with rest at the end, too.
synthetic::Script twoPoses() {
  return synthetic::Script(kCoilsInTurn)
      .rest(1.0)
      .moveTo({0.2, -0.1, 0.7}, 1.0)
      .rest(2.0)
      .excite(1, 1.5, 2.5)
      .excite(2, -1.5, 2.5)
      .moveTo({0.0, 0.3, 0.1}, 1.0)
      .rest(2.0)
      .excite(1, 1.5, 2.5)
      .rest(2.0)
      .moveTo({0.0, 0.0, 0.0}, 1.0)
      .rest(1.0);
}

synthetic::Streams recorded() {
  synthetic::Sensors sensors;
  sensors.torque_bias = {1e-3, -2e-3, 3e-3};
  sensors.jitter = 0.3;
  return synthetic::record(twoPoses(), sensors, 1);
}

synthetic::Streams after(const synthetic::Streams& all, double time) {
  const auto begin = [time](const auto& stream) {
    return std::find_if(stream.begin(), stream.end(), [time](const auto& measurement) {
      return synthetic::timeOf(measurement.stamp) > time;
    });
  };
  return {{begin(all.joints), all.joints.end()},
          {begin(all.orientations), all.orientations.end()},
          {begin(all.torques), all.torques.end()},
          {begin(all.currents), all.currents.end()}};
}

/// A stretch in which no torque arrives: all of it comes at its end [s].
struct Silence {
  double begin = 0.0;
  double end = 0.0;
};

/// What a session captures that asks, from these times on, as often as any measurement comes.
std::vector<Sample> captured(const synthetic::Streams& streams,
                             const std::vector<double>& times,
                             double duration,
                             const Silence& silence = {}) {
  std::vector<Sample> samples;
  SampleBuilder builder({}, kCoilsInTurn);
  std::size_t torque = 0;
  std::size_t current = 0;
  std::size_t orientation = 0;
  for (const JointMeasurement& joints : streams.joints) {
    const auto catch_up = [&](const auto& stream, std::size_t& index) {
      for (; index < stream.size() && stream[index].stamp <= joints.stamp; ++index) {
        builder.add(stream[index]);
      }
    };
    catch_up(streams.orientations, orientation);
    const double now = synthetic::timeOf(joints.stamp);
    if (now <= silence.begin || now > silence.end) {
      catch_up(streams.torques, torque);
    }
    catch_up(streams.currents, current);
    builder.add(joints);
    if (samples.size() == times.size() || times[samples.size()] > now) {
      continue;
    }
    CaptureProgress progress = builder.capture(synthetic::stampAt(times[samples.size()]), duration);
    if (progress.state == CaptureProgress::State::kDone) {
      samples.push_back(*progress.sample);
      samples.back().id = static_cast<std::uint32_t>(10 + samples.size());
      samples.back().validation = samples.size() == 2;
    }
  }
  return samples;
}

std::vector<Sample> repeated(const std::vector<Sample>& taken,
                             const synthetic::Streams& streams,
                             const SampleBuilderOptions& options = {}) {
  SampleBuilder builder(options, kCoilsInTurn);
  builder.repeat(taken);
  return synthetic::samplesOf(builder, streams);
}

void expectEqual(const std::vector<Sample>& samples, const std::vector<Sample>& expected) {
  ASSERT_EQ(samples.size(), expected.size());
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const Sample& sample = samples[n];
    const Sample& other = expected[n];
    EXPECT_EQ(sample.id, other.id);
    EXPECT_EQ(sample.stamp, other.stamp);
    EXPECT_EQ(sample.dwell, other.dwell);
    EXPECT_EQ(sample.duration, other.duration);
    EXPECT_EQ(sample.validation, other.validation);
    EXPECT_EQ(sample.measurements, other.measurements);
    EXPECT_EQ(sample.joint_position, other.joint_position);
    EXPECT_EQ(sample.joint_stddev, other.joint_stddev);
    EXPECT_EQ(sample.R_stator_rotor, other.R_stator_rotor);
    EXPECT_EQ(sample.has_torque, other.has_torque);
    EXPECT_EQ(sample.torque, other.torque);
    EXPECT_EQ(sample.torque_stddev, other.torque_stddev);
    EXPECT_EQ(sample.current, other.current);
  }
}

/// One within each pattern. The first ones wait for rest and for the current.
std::vector<Sample> session(const synthetic::Streams& streams) {
  return captured(streams, {2.0, 4.05, 7.0, 10.5, 12.5}, 0.7);
}

TEST(RepeatedSamples, AreThoseThatWereCaptured) {
  const synthetic::Streams streams = recorded();
  const std::vector<Sample> taken = session(streams);
  ASSERT_EQ(taken.size(), 5U);
  EXPECT_TRUE(taken[1].has_torque);
  expectEqual(repeated(taken, streams), taken);
}

TEST(RepeatedSamples, AreTheSameWhereTheRecordingBeganEarlier) {
  const synthetic::Streams streams = recorded();
  // The node came up while the rotor rested at the first pose.
  const std::vector<Sample> taken = captured(after(streams, 2.5), {2.6, 4.5, 7.0}, 0.7);
  ASSERT_EQ(taken.size(), 3U);
  expectEqual(repeated(taken, streams), taken);
}

TEST(RepeatedSamples, AreTheSameWhereWhatWasMeasuredBeforeCameTooLate) {
  const synthetic::Streams streams = recorded();
  // Of the torque without current, before the excited captures, 0.4 s come too late.
  const std::vector<Sample> taken = captured(streams, {4.05, 7.0}, 0.7, {2.3, 3.7});
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_GT(taken[0].torque_shared_stddev, 0.0);
  const std::vector<Sample> again = repeated(taken, streams);
  expectEqual(again, taken);
  EXPECT_EQ(again[0].torque_shared_stddev, taken[0].torque_shared_stddev);
}

TEST(RepeatedSamples, AreThoseOfWholeDwellsWhereTheseWereTaken) {
  const synthetic::Streams streams = recorded();
  SampleBuilder live({}, kCoilsInTurn);
  std::vector<Sample> taken = synthetic::samplesOf(live, streams);
  ASSERT_GE(taken.size(), 6U);
  expectEqual(repeated(taken, streams), taken);
}

TEST(RepeatedSamples, FollowOtherOptions) {
  const synthetic::Streams streams = recorded();
  const std::vector<Sample> taken = session(streams);
  SampleBuilderOptions options;
  options.settle_after_current_change = 0.5;
  options.torque_stddev_floor = 0.01;
  const std::vector<Sample> samples = repeated(taken, streams, options);
  ASSERT_EQ(samples.size(), taken.size());
  // The second one began as soon as the current had settled for 0.1 s.
  EXPECT_NEAR(samples[1].duration, taken[1].duration - 0.4, 0.02);
  EXPECT_GE(samples[1].torque_stddev, 0.01);

  options.largest_joint_spread = 1e-6;
  SampleBuilder builder(options, kCoilsInTurn);
  builder.repeat(taken);
  EXPECT_TRUE(synthetic::samplesOf(builder, streams).empty());
  EXPECT_EQ(builder.report().discarded, taken.size());
}

TEST(RepeatedSamples, TellWhatTheStreamsDoNotHold) {
  const synthetic::Streams streams = recorded();
  const std::vector<Sample> taken = session(streams);
  SampleBuilder builder({}, kCoilsInTurn);
  builder.repeat(taken);
  // It begins in the first rest, after its part without current.
  const std::vector<Sample> samples = synthetic::samplesOf(builder, after(streams, 4.9));
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[1].torque, taken[3].torque);
  EXPECT_EQ(samples[2].torque, taken[4].torque);
  const SampleBuilderReport& report = builder.report();
  EXPECT_EQ(report.discarded, 2U);
  EXPECT_EQ(report.events[0].reason, "Sample 11: the streams show no rest of the rotor there.");
  EXPECT_EQ(report.events[2].reason,
            "The torque bias is not removed: the dwell has no part without current.");
}

TEST(RepeatedSamples, OfNonsenseAreRefusedAndHoldNothingBack) {
  const synthetic::Streams streams = recorded();
  std::vector<Sample> taken = session(streams);
  Sample nonsense = taken.front();
  nonsense.stamp = 1;
  nonsense.dwell = std::numeric_limits<Stamp>::max() / 2;
  nonsense.duration = std::numeric_limits<double>::infinity();
  taken.push_back(nonsense);
  nonsense.stamp = std::numeric_limits<Stamp>::max() / 2;
  nonsense.dwell = 1;
  taken.push_back(nonsense);
  nonsense.duration = -1.0;
  taken.push_back(nonsense);
  EXPECT_EQ(repeated(taken, streams).size(), 5U);
}

TEST(RepeatedSamples, EndWithTheirRecording) {
  const synthetic::Streams streams = recorded();
  SampleBuilder builder({}, kCoilsInTurn);
  builder.repeat(session(streams));
  EXPECT_EQ(synthetic::samplesOf(builder, streams).size(), 5U);
  EXPECT_GE(synthetic::samplesOf(builder, streams).size(), 6U);
}

}  // namespace
}  // namespace sac
