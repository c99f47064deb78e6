#include "spherical_actuator_calibration/streams/sample_builder.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "streams/scripted_dwell.hpp"
#include "support/error_message.hpp"
#include "support/synthetic_streams.hpp"

namespace sac {
namespace {

using synthetic::samplesOf;
using synthetic::Script;
using synthetic::Sensors;
using synthetic::stampAt;
using synthetic::Streams;
using synthetic::timeOf;

Eigen::VectorXd pattern(Eigen::Index coil, double current) {
  return current * Eigen::VectorXd::Unit(kCoils, coil);
}

SampleBuilderOptions withoutFloors() {
  SampleBuilderOptions options;
  options.joint_stddev_floor = 0.0;
  options.orientation_stddev_floor = 0.0;
  options.torque_stddev_floor = 0.0;
  return options;
}

std::vector<std::string> reasons(const SampleBuilder& builder) {
  std::vector<std::string> texts;
  for (const DwellEvent& event : builder.report().events) {
    texts.push_back(event.reason);
  }
  return texts;
}

void expectIdentical(const Sample& a, const Sample& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.joint_position, b.joint_position);
  EXPECT_EQ(a.joint_stddev, b.joint_stddev);
  EXPECT_EQ(a.has_orientation, b.has_orientation);
  EXPECT_EQ(a.R_stator_rotor, b.R_stator_rotor);
  EXPECT_EQ(a.has_torque, b.has_torque);
  EXPECT_EQ(a.torque, b.torque);
  EXPECT_EQ(a.current, b.current);
  EXPECT_EQ(a.duration, b.duration);
  EXPECT_EQ(a.measurements, b.measurements);
  EXPECT_EQ(a.orientation_stddev, b.orientation_stddev);
  EXPECT_EQ(a.torque_stddev, b.torque_stddev);
}

TEST(SampleBuilder, SplitsADwellByCurrentPattern) {
  SampleBuilder builder({}, kCoils);
  Sensors sensors;
  sensors.torque_bias = Eigen::Vector3d(0.1, -0.2, 0.3);
  const std::vector<Sample> samples =
      samplesOf(builder, synthetic::record(twoPatterns(), sensors, 1));
  ASSERT_EQ(samples.size(), 4U);
  const std::vector<bool> has_torque = {false, true, true, false};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Sample& sample = samples[k];
    EXPECT_NO_THROW(validate(sample, kCoils));
    EXPECT_EQ(sample.id, k + 1);
    EXPECT_TRUE(sample.has_orientation);
    EXPECT_EQ(sample.has_torque, has_torque[k]);
    EXPECT_LT((sample.joint_position - rest_pose).norm(), 2e-5);
    EXPECT_LT(
        rotationLog(sample.R_stator_rotor * Script::orientation(rest_pose).transpose()).norm(),
        5e-4);
  }
  for (std::size_t k = 1; k < 3; ++k) {
    const Eigen::VectorXd current = k == 1 ? pattern(0, 2.0) : pattern(2, -1.5);
    EXPECT_LT((samples[k].current - current).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT((samples[k].torque - Script::torque(current)).norm(), 1e-3);
  }
  for (const Sample& sample : samples) {
    EXPECT_EQ(sample.dwell, samples.front().dwell);
    EXPECT_NE(sample.dwell, 0);
    // The readings are fine, but the torque without current is the same of all.
    EXPECT_TRUE(sample.joint_shared_stddev.isZero(0.0));
    EXPECT_EQ(sample.torque_shared_stddev > 0.0, sample.has_torque);
  }
  EXPECT_EQ(samples[1].torque_shared_stddev, samples[2].torque_shared_stddev);
  EXPECT_LT(samples[1].torque_shared_stddev, samples[1].torque_stddev);
  // The pattern from 1.6 s to 2.4 s, less settling and guard.
  EXPECT_NEAR(timeOf(samples[1].stamp), 2.04, 0.01);
  EXPECT_NEAR(samples[1].duration, 0.68, 0.01);
  EXPECT_EQ(builder.report().dwells, 1U);
  EXPECT_EQ(builder.report().samples, 4U);
  EXPECT_EQ(builder.report().discarded, 0U);
}

TEST(SampleBuilder, TakesTheOffsetOfCurrentSensorsOut) {
  SampleBuilder builder({}, kCoils);
  Sensors sensors;
  sensors.current_offset = 0.03;
  const std::vector<Sample> samples =
      samplesOf(builder, synthetic::record(twoPatterns(), sensors, 1));
  ASSERT_EQ(samples.size(), 4U);
  EXPECT_LT((samples[1].current - pattern(0, 2.0)).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_NEAR(samples[0].current[0], 0.03, 1e-3);
}

TEST(SampleBuilder, KeepsTheBiasOnRequest) {
  SampleBuilderOptions options;
  options.bias_removal = BiasRemoval::kNone;
  SampleBuilder builder(options, kCoils);
  Sensors sensors;
  sensors.torque_bias = Eigen::Vector3d(0.1, -0.2, 0.3);
  const std::vector<Sample> samples =
      samplesOf(builder, synthetic::record(twoPatterns(), sensors, 1));
  ASSERT_EQ(samples.size(), 4U);
  EXPECT_TRUE(samples[0].has_torque);
  EXPECT_LT((samples[0].torque - sensors.torque_bias).norm(), 1e-3);
  const Eigen::Vector3d expected = Script::torque(pattern(0, 2.0)) + sensors.torque_bias;
  EXPECT_LT((samples[1].torque - expected).norm(), 1e-3);
}

TEST(SampleBuilder, TellsThatTheBiasCouldNotBeRemoved) {
  SampleBuilder builder({}, kCoils);
  Sensors sensors;
  sensors.torque_bias = Eigen::Vector3d(0.1, 0.0, 0.0);
  const Script script = Script(kCoils).excite(1, 2.0, 2.0);
  const std::vector<Sample> samples = samplesOf(builder, synthetic::record(script, sensors, 1));
  ASSERT_EQ(samples.size(), 1U);
  const Eigen::Vector3d expected = Script::torque(pattern(1, 2.0)) + sensors.torque_bias;
  EXPECT_LT((samples[0].torque - expected).norm(), 1e-3);
  EXPECT_EQ(reasons(builder),
            std::vector<std::string>{
                "The torque bias is not removed: the dwell has no part without current."});
}

TEST(SampleBuilder, ADwellWithoutExcitationKeepsItsTorque) {
  SampleBuilder builder({}, kCoils);
  const Script script = Script(kCoils).moveTo(rest_pose).rest(1.5).moveTo(-rest_pose);
  const std::vector<Sample> samples = samplesOf(builder, synthetic::record(script, {}, 1));
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_TRUE(samples[0].has_torque);
  EXPECT_TRUE(samples[0].has_orientation);
}

TEST(SampleBuilder, WithoutCurrentsTheDwellIsOneSampleWithoutTorque) {
  Sensors sensors;
  sensors.current_rate = 0.0;
  const Streams streams = synthetic::record(twoPatterns(), sensors, 1);
  SampleBuilder builder({}, kCoils);
  const std::vector<Sample> samples = samplesOf(builder, streams);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_FALSE(samples[0].has_torque);
  EXPECT_EQ(samples[0].current.size(), 0);
  EXPECT_EQ(reasons(builder),
            std::vector<std::string>{"The torque is left out: no currents were measured."});
}

TEST(SampleBuilder, AnActuatorWithoutCoilsGivesOrientationSamples) {
  Sensors sensors;
  sensors.torque_rate = 0.0;
  SampleBuilder builder({}, 0);
  const std::vector<Sample> samples =
      samplesOf(builder, synthetic::record(twoPatterns(), sensors, 1));
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_TRUE(samples[0].has_orientation);
  EXPECT_EQ(builder.report().currents.received, 0U);
  EXPECT_TRUE(reasons(builder).empty());
}

TEST(SampleBuilder, MeansHoldTheTruthAsOftenAsStated) {
  constexpr int kSeeds = 400;
  const Script script =
      Script(kCoils).moveTo(rest_pose).rest(0.7).excite(0, 2.0, 0.6).rest(0.4).moveTo(-rest_pose);
  const Eigen::Matrix3d R = Script::orientation(rest_pose);
  int joints = 0;
  int orientations = 0;
  int torques = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    SampleBuilder builder(withoutFloors(), kCoils);
    Sensors sensors;
    sensors.torque_bias = Eigen::Vector3d(0.1, -0.2, 0.3);
    const std::vector<Sample> samples =
        samplesOf(builder, synthetic::record(script, sensors, static_cast<std::uint64_t>(seed)));
    ASSERT_EQ(samples.size(), 2U);
    const Sample& sample = samples[1];
    const Eigen::Array3d joint_error = (sample.joint_position - rest_pose).array().abs();
    const Eigen::Array3d orientation_error =
        rotationLog(sample.R_stator_rotor * R.transpose()).array().abs();
    // With the model's torque of the stated current: their errors belong together.
    const Eigen::Array3d torque_error =
        (sample.torque - Script::torque(pattern(0, 2.0))).array().abs();
    joints += static_cast<int>((joint_error <= 1.96 * sample.joint_stddev.array()).count());
    orientations +=
        static_cast<int>((orientation_error <= 1.96 * sample.orientation_stddev).count());
    torques += static_cast<int>((torque_error <= 1.96 * sample.torque_stddev).count());
  }
  EXPECT_NEAR(joints / (3.0 * kSeeds), 0.95, 0.02);
  EXPECT_NEAR(orientations / (3.0 * kSeeds), 0.95, 0.02);
  EXPECT_NEAR(torques / (3.0 * kSeeds), 0.95, 0.02);
}

TEST(SampleBuilder, NothingOfTheMotionEnters) {
  // Fast and slow moves: the mean of the dwell must not be drawn towards them.
  for (const double move : {0.3, 0.8, 2.0, 4.0}) {
    Sensors sensors;
    sensors.joint_noise = 1e-7;
    SampleBuilder builder({}, kCoils);
    const Script script =
        Script(kCoils).moveTo(rest_pose, move).rest(1.0).moveTo(-rest_pose, move).rest(1.0);
    const std::vector<Sample> samples = samplesOf(builder, synthetic::record(script, sensors, 1));
    ASSERT_EQ(samples.size(), 2U) << move;
    EXPECT_LT((samples[0].joint_position - rest_pose).cwiseAbs().maxCoeff(), 2e-5) << move;
    EXPECT_LT((samples[1].joint_position + rest_pose).cwiseAbs().maxCoeff(), 2e-5) << move;
  }
}

TEST(SampleBuilder, AMovingRotorGivesNoSample) {
  // Without a stop, from creeping to fast.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SampleBuilder builder({}, kCoils);
    Script script(kCoils);
    const double direction = seed % 2 == 0 ? 1.0 : -1.0;
    const double speed = 1e-3 * std::pow(1.5, static_cast<double>(seed));
    script.driftBy(direction * speed * 4.0 * Eigen::Vector3d(1.0, -0.5, 0.2), 4.0);
    const std::vector<Sample> samples = samplesOf(builder, synthetic::record(script, {}, seed));
    EXPECT_TRUE(samples.empty()) << "speed " << speed;
  }
}

TEST(SampleBuilder, DriftIsToldAndNeverADwell) {
  SampleBuilder builder({}, kCoils);
  const Script script =
      Script(kCoils).rest(0.01).driftBy(Eigen::Vector3d(0.0, 2e-3, 0.0), 4.0).rest(0.01);
  EXPECT_TRUE(samplesOf(builder, synthetic::record(script, {}, 1)).empty());
  EXPECT_EQ(builder.report().dwells, 1U);
  EXPECT_EQ(builder.report().discarded, 1U);
  ASSERT_EQ(builder.report().events.size(), 1U);
  EXPECT_EQ(builder.report().events[0].kind, DwellEvent::Kind::kDiscarded);
  EXPECT_EQ(builder.report().events[0].reason.substr(0, 19), "joint_2 drifted by ");
}

TEST(SampleBuilder, TellsOfAShortRest) {
  SampleBuilder builder({}, kCoils);
  const Script script = Script(kCoils).moveTo(rest_pose, 0.3).rest(0.4).moveTo(-rest_pose, 0.3);
  EXPECT_TRUE(samplesOf(builder, synthetic::record(script, {}, 1)).empty());
  ASSERT_EQ(builder.report().events.size(), 1U);
  EXPECT_EQ(builder.report().events[0].reason.substr(0, 26), "The rotor rested only for ");
}

TEST(SampleBuilder, TellsOfAShortExcitationButNotOfAShortEnd) {
  SampleBuilder builder({}, kCoils);
  // The last 0.3 s without current go with the guard.
  const Script script =
      Script(kCoils).moveTo(rest_pose).rest(0.8).excite(0, 2.0, 0.25).rest(0.3).moveTo(-rest_pose);
  const std::vector<Sample> samples = samplesOf(builder, synthetic::record(script, {}, 1));
  EXPECT_EQ(samples.size(), 1U);
  ASSERT_EQ(reasons(builder).size(), 1U);
  EXPECT_EQ(reasons(builder)[0].substr(0, 16), "It lasts only 0.");
  EXPECT_EQ(builder.report().discarded, 1U);
}

TEST(SampleBuilder, TellsOfADwellWithoutConstantCurrent) {
  SampleBuilder builder({}, kCoils);
  const Script script = Script(kCoils).rampTo(0, 2.0, 2.0);
  EXPECT_TRUE(samplesOf(builder, synthetic::record(script, {}, 1)).empty());
  EXPECT_EQ(reasons(builder),
            std::vector<std::string>{"No part of it with constant current is long enough."});
}

TEST(SampleBuilder, TheOrderOfArrivalDoesNotMatter) {
  const Script script = twoPatterns()
                            .rest(1.0)
                            .moveTo(rest_pose)
                            .rest(1.2)
                            .excite(3, 1.0, 1.0)
                            .moveTo(Eigen::Vector3d::Zero());
  Sensors sensors;
  sensors.jitter = 0.8;
  Streams streams = synthetic::record(script, sensors, 9);
  // Defects make their own decisions; they too must not depend on the order.
  streams.torques[900].torque.x() = std::nan("");
  streams.orientations[300].q_stator_rotor.coeffs() *= 1.1;
  streams.joints[200].stamp = streams.joints[199].stamp;
  streams.torques[1200].stamp -= ticksFromSeconds(0.02);
  streams.currents[400].stamp += ticksFromSeconds(500.0);
  streams.orientations.erase(streams.orientations.begin() + 320,
                             streams.orientations.begin() + 400);
  streams.joints.erase(streams.joints.begin() + 1000, streams.joints.begin() + 1060);
  SampleBuilder reference({}, kCoils);
  const std::vector<Sample> expected = samplesOf(reference, streams);
  ASSERT_GE(expected.size(), 5U);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SampleBuilder builder({}, kCoils);
    synthetic::feedDelayed(builder, streams, 0.1, seed);
    builder.finish();
    const std::vector<Sample> samples = builder.takeSamples();
    ASSERT_EQ(samples.size(), expected.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
      expectIdentical(samples[k], expected[k]);
    }
    EXPECT_EQ(reasons(builder), reasons(reference));
    EXPECT_EQ(describe("torque", builder.report().torques),
              describe("torque", reference.report().torques));
  }
}

TEST(SampleBuilder, ADwellIsReadyOnceEveryStreamHasPassedIt) {
  const Script script = Script(kCoils).moveTo(rest_pose).rest(1.5).moveTo(-rest_pose, 2.0);
  const Streams streams = synthetic::record(script, {}, 1);
  SampleBuilder builder({}, kCoils);
  synthetic::feed(builder, streams);
  // The move lasts longer than any delay: no need to finish.
  EXPECT_EQ(builder.takeSamples().size(), 1U);
  EXPECT_TRUE(builder.takeSamples().empty());
}

template <typename Measurement>
void cutAfter(double time, std::vector<Measurement>& stream) {
  while (!stream.empty() && timeOf(stream.back().stamp) > time) {
    stream.pop_back();
  }
}

TEST(SampleBuilder, WaitsForASilentStreamOnlyUpToTheTimeout) {
  // The dwell ends at 2.4 s.
  const Script script = Script(kCoils).moveTo(rest_pose).rest(1.5).moveTo(-rest_pose, 2.0);
  const Streams streams = synthetic::record(script, {}, 1);
  enum class Silent { kJoints, kOrientations, kTorques, kCurrents };
  for (const Silent silent :
       {Silent::kJoints, Silent::kOrientations, Silent::kTorques, Silent::kCurrents}) {
    const auto samples_until = [&streams, silent](double time) {
      const double own = std::min(time, 2.2);
      Streams part = streams;
      cutAfter(silent == Silent::kJoints ? own : time, part.joints);
      cutAfter(silent == Silent::kOrientations ? own : time, part.orientations);
      cutAfter(silent == Silent::kTorques ? own : time, part.torques);
      cutAfter(silent == Silent::kCurrents ? own : time, part.currents);
      SampleBuilder builder({}, kCoils);
      synthetic::feed(builder, part);
      return builder.takeSamples().size();
    };
    EXPECT_EQ(samples_until(3.0), 0U) << static_cast<int>(silent);
    EXPECT_EQ(samples_until(3.8), 1U) << static_cast<int>(silent);
  }
}

TEST(SampleBuilder, FinishAllowsAnotherRecordingOfAnEarlierTime) {
  const Streams streams = synthetic::record(twoPatterns(), {}, 1);
  SampleBuilder builder({}, kCoils);
  const std::vector<Sample> first = samplesOf(builder, streams);
  const std::vector<Sample> second = samplesOf(builder, streams);
  ASSERT_EQ(first.size(), 4U);
  ASSERT_EQ(second.size(), 4U);
  EXPECT_EQ(second[0].id, 5U);
  EXPECT_EQ(second[1].torque, first[1].torque);
  EXPECT_EQ(builder.report().joints.clock_resets, 0U);
}

TEST(SampleBuilder, RefusesOptionsOutOfRange) {
  SampleBuilderOptions options;
  options.rest_window = -1.0;
  EXPECT_EQ(errorMessage<ConfigError>([&options] { const SampleBuilder builder(options, 1); }),
            "rest_window: -1 is outside (0, inf) s.");
  options = {};
  options.smallest_count = 0;
  EXPECT_THROW(validate(options), ConfigError);
  options = {};
  options.torque_stddev_floor = std::nan("");
  EXPECT_THROW(validate(options), ConfigError);
}

}  // namespace
}  // namespace sac
