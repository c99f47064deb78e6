#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "streams/coils_in_turn.hpp"
#include "support/synthetic_streams.hpp"

namespace sac {
namespace {

using State = CaptureProgress::State;

/// Measurements with begin < time ≤ end [s since the begin of the script].
synthetic::Streams between(const synthetic::Streams& all, double begin, double end) {
  const auto pick = [&](const auto& from, auto& to) {
    for (const auto& measurement : from) {
      const double time = synthetic::timeOf(measurement.stamp);
      if (time > begin && time <= end) {
        to.push_back(measurement);
      }
    }
  };
  synthetic::Streams part;
  pick(all.joints, part.joints);
  pick(all.orientations, part.orientations);
  pick(all.torques, part.torques);
  pick(all.currents, part.currents);
  return part;
}

/// A move until 1 s, rest without current until 3 s, then coil 2 with 1.5 A until 6 s, then a move.
synthetic::Script restThenExcited() {
  return synthetic::Script(kCoilsInTurn)
      .moveTo({0.2, -0.1, 0.7}, 1.0)
      .rest(2.0)
      .excite(1, 1.5, 3.0)
      .moveTo({0.0, 0.0, 0.0}, 1.0)
      .rest(1.0);
}

class Capture : public ::testing::Test {
 protected:
  void feedUntil(double time) {
    synthetic::feed(builder_, between(streams_, fed_, time));
    fed_ = time;
  }

  synthetic::Sensors sensors_ = [] {
    synthetic::Sensors sensors;
    sensors.torque_bias = {1e-3, -2e-3, 3e-3};
    return sensors;
  }();
  synthetic::Streams streams_ = synthetic::record(restThenExcited(), sensors_, 1);
  SampleBuilder builder_{{}, kCoilsInTurn};
  double fed_ = -1.0;
};

TEST_F(Capture, AveragesThePresentPatternAndRemovesTheBias) {
  feedUntil(3.5);
  EXPECT_EQ(builder_.capture(synthetic::stampAt(3.5), 1.0).state, State::kWaiting);
  feedUntil(4.8);
  const CaptureProgress progress = builder_.capture(synthetic::stampAt(3.5), 1.0);
  ASSERT_EQ(progress.state, State::kDone) << progress.message;
  EXPECT_EQ(progress.message, "");
  const Sample& sample = *progress.sample;
  EXPECT_NEAR(sample.duration, 1.0, 1e-9);
  EXPECT_NEAR(synthetic::timeOf(sample.stamp), 4.0, 1e-9);
  EXPECT_TRUE(sample.has_orientation);
  ASSERT_TRUE(sample.has_torque);
  EXPECT_NEAR(sample.current[1], 1.5, 5e-3);
  const Eigen::Vector3d truth = synthetic::Script::torque(restThenExcited().current(4.0));
  EXPECT_LT((sample.torque - truth).norm(), 5.0 * std::sqrt(3.0) * sample.torque_stddev);
  EXPECT_GT(sensors_.torque_bias.norm(), 10.0 * std::sqrt(3.0) * sample.torque_stddev);
}

TEST_F(Capture, BeginsWhenTheCurrentsHaveSettled) {
  feedUntil(4.5);
  const CaptureProgress progress = builder_.capture(synthetic::stampAt(2.95), 1.0);
  ASSERT_EQ(progress.state, State::kDone) << progress.message;
  EXPECT_GT(synthetic::timeOf(progress.sample->stamp), 3.1 + 0.5 - 0.01);
  EXPECT_NEAR(progress.sample->current[1], 1.5, 5e-3);
}

TEST_F(Capture, ChangesNothing) {
  feedUntil(4.8);
  ASSERT_EQ(builder_.capture(synthetic::stampAt(3.5), 1.0).state, State::kDone);
  feedUntil(9.0);
  builder_.finish();
  SampleBuilder untouched({}, kCoilsInTurn);
  const std::vector<Sample> expected = synthetic::samplesOf(untouched, streams_);
  const std::vector<Sample> samples = builder_.takeSamples();
  ASSERT_EQ(samples.size(), expected.size());
  for (std::size_t n = 0; n < samples.size(); ++n) {
    EXPECT_EQ(samples[n].torque, expected[n].torque);
  }
}

TEST_F(Capture, WaitsForRestButNotForEver) {
  feedUntil(0.5);
  const CaptureProgress moving = builder_.capture(synthetic::stampAt(0.5), 0.5);
  EXPECT_EQ(moving.state, State::kWaiting);
  EXPECT_EQ(moving.message, "The rotor moves: let it rest.");

  const synthetic::Streams restless =
      synthetic::record(synthetic::Script(kCoilsInTurn).driftBy({1.0, 0.0, 0.0}, 6.0), {}, 1);
  SampleBuilder builder({}, kCoilsInTurn);
  synthetic::feed(builder, restless);
  const CaptureProgress refused = builder.capture(synthetic::stampAt(0.5), 0.5);
  EXPECT_EQ(refused.state, State::kRefused);
  EXPECT_EQ(refused.message, "The rotor moves: let it rest.");
}

TEST_F(Capture, RefusesAPatternThatEndsTooSoon) {
  feedUntil(6.4);
  const CaptureProgress progress = builder_.capture(synthetic::stampAt(5.0), 2.0);
  EXPECT_NE(progress.state, State::kDone);
}

TEST_F(Capture, NamesAStreamThatFellSilent) {
  feedUntil(3.5);
  synthetic::Streams rest = between(streams_, 3.5, 5.0);
  rest.orientations.clear();
  synthetic::feed(builder_, rest);
  const CaptureProgress progress = builder_.capture(synthetic::stampAt(4.9), 0.5);
  EXPECT_EQ(progress.state, State::kRefused);
  EXPECT_NE(progress.message.find("measured_orientation is silent for 1.5"), std::string::npos)
      << progress.message;
}

TEST_F(Capture, TakesAnAbsentStreamForAbsent) {
  synthetic::Sensors sensors;
  sensors.orientation_rate = 0.0;
  SampleBuilder builder({}, kCoilsInTurn);
  synthetic::feed(builder, between(synthetic::record(restThenExcited(), sensors, 1), -1.0, 4.8));
  const CaptureProgress progress = builder.capture(synthetic::stampAt(3.5), 1.0);
  ASSERT_EQ(progress.state, State::kDone) << progress.message;
  EXPECT_FALSE(progress.sample->has_orientation);
  EXPECT_TRUE(progress.sample->has_torque);
}

TEST_F(Capture, TellsThatTheBiasStays) {
  const synthetic::Streams streams =
      synthetic::record(synthetic::Script(kCoilsInTurn).excite(1, 1.5, 4.0), sensors_, 1);
  SampleBuilder builder({}, kCoilsInTurn);
  synthetic::feed(builder, streams);
  const CaptureProgress progress = builder.capture(synthetic::stampAt(1.0), 1.0);
  ASSERT_EQ(progress.state, State::kDone) << progress.message;
  EXPECT_NE(progress.message.find("bias is not removed"), std::string::npos) << progress.message;
}

TEST_F(Capture, RefusesWhatIsNoDuration) {
  feedUntil(4.8);
  for (const double duration : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    const CaptureProgress progress = builder_.capture(synthetic::stampAt(3.5), duration);
    EXPECT_EQ(progress.state, State::kRefused);
    EXPECT_NE(progress.message.find("duration must lie between 0.2 and 60 s"), std::string::npos);
  }
}

TEST_F(Capture, EndsWhenTheClockIsSetBack) {
  feedUntil(3.5);
  const CaptureProgress progress = builder_.capture(synthetic::stampAt(100.0), 1.0);
  EXPECT_EQ(progress.state, State::kRefused);
  EXPECT_NE(progress.message.find("set back"), std::string::npos) << progress.message;
}

TEST_F(Capture, BeginsAfterWhatCameTooLate) {
  feedUntil(4.0);
  TorqueMeasurement late{synthetic::stampAt(4.3), {0.1, 0.2, 0.3}};
  synthetic::Streams ahead = between(streams_, 4.0, 5.45);
  ahead.torques.clear();
  synthetic::feed(builder_, ahead);
  builder_.add(late);
  fed_ = 5.45;
  feedUntil(5.6);
  const CaptureProgress waiting = builder_.capture(synthetic::stampAt(4.2), 1.0);
  EXPECT_EQ(waiting.state, State::kWaiting);
  EXPECT_NE(waiting.message.find("came too late"), std::string::npos) << waiting.message;
  feedUntil(5.8);
  const CaptureProgress done = builder_.capture(synthetic::stampAt(4.2), 1.0);
  ASSERT_EQ(done.state, State::kDone) << done.message;
  EXPECT_GT(done.sample->dwell, late.stamp);
  EXPECT_GT(secondsBetween(late.stamp, done.sample->stamp), 0.5);
  // What acted without current was measured before: some of that may be missing, too.
  EXPECT_NE(done.message.find("no part without current"), std::string::npos) << done.message;
}

TEST(CaptureWithoutStreams, NamesWhatIsMissing) {
  const SampleBuilder builder({}, kCoilsInTurn);
  const CaptureProgress progress = builder.capture(0, 1.0);
  EXPECT_EQ(progress.state, State::kRefused);
  EXPECT_NE(progress.message.find("joint_states"), std::string::npos);
}

}  // namespace
}  // namespace sac
