#include "spherical_actuator_calibration/assessment/sample_influence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "support/moving_rotor.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

std::vector<Sample> paperSamples(std::uint64_t seed) {
  scenarios::Generator generator(seed);
  return scenarios::paperSession(
      scenarios::paperTruth(), scenarios::Tracker::kFirstTenPoses, generator);
}

/// Refined from the samples; no observation is taken for an outlier.
CalibrationSession refined(const std::vector<Sample>& samples) {
  CalibrationConfig config;
  config.estimation.false_alarm_probability = 1e-12;
  CalibrationSession session({scenarios::paperNominal()}, samples, config);
  session.run({Cycle::kJoint});
  session.run({Cycle::kPoles, 0});
  session.run({Cycle::kRefine});
  return session;
}

/// Refines again without some of the samples.
void expectInfluencesOfLeavingOut(const std::vector<Sample>& samples,
                                  const std::vector<std::size_t>& left_out) {
  const CalibrationSession session = refined(samples);
  const std::vector<SampleInfluence> influences = sampleInfluences(session);
  ASSERT_EQ(influences.size(), samples.size());
  const Eigen::VectorXd stddevs = session.state().belief.covariance.diagonal().cwiseSqrt();
  for (const std::size_t n : left_out) {
    std::vector<Sample> others = samples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(n));
    const CalibrationSession without = refined(others);
    const double shift = (without.state().belief.x - session.state().belief.x)
                             .cwiseAbs()
                             .cwiseQuotient(stddevs)
                             .maxCoeff();
    EXPECT_EQ(influences[n].id, samples[n].id);
    EXPECT_NEAR(influences[n].largest_shift, shift, 0.1 * shift + 0.02) << n;
  }
}

TEST(SampleInfluence, IsWhatLeavingTheSampleOutDoes) {
  expectInfluencesOfLeavingOut(paperSamples(1), {2, 14, 37, 70});
}

/// Torques of all coils in turn, eight at each rest, where they share the errors of the readings of
/// the joints, far larger than their own, and of the torque without current; then orientations.
std::vector<Sample> restsSamples() {
  constexpr std::size_t kRests = 24;
  constexpr std::size_t kCoilsAtRest = 8;
  constexpr double kReadingStddev = 5e-4;
  constexpr double kSharedTorque = 2e-4;
  constexpr double kOwnTorque = 1e-4;
  const Actuator truth = scenarios::paperTruth();
  scenarios::Generator generator(4);
  std::normal_distribution<double> normal;
  const auto vector = [&](double stddev) {
    return Eigen::Vector3d(
        stddev * normal(generator), stddev * normal(generator), stddev * normal(generator));
  };
  std::vector<Sample> samples;
  std::size_t coil = 0;
  for (std::size_t rest = 0; rest < kRests; ++rest) {
    const Eigen::Vector3d q = scenarios::randomPose(0.5, generator);
    const Eigen::Vector3d reading_error = vector(kReadingStddev);
    const Eigen::Vector3d torque_error = vector(kSharedTorque);
    for (std::size_t n = 0; n < kCoilsAtRest; ++n) {
      Sample sample =
          scenarios::torqueSamples(
              truth, {q}, coil, 2.0, 0.0, std::hypot(kOwnTorque, kSharedTorque), generator)
              .front();
      sample.torque += torque_error + vector(kOwnTorque);
      sample.torque_shared_stddev = kSharedTorque;
      sample.joint_position += reading_error;
      sample.joint_stddev.setConstant(kReadingStddev);
      sample.joint_shared_stddev.setConstant(kReadingStddev);
      sample.dwell = static_cast<Stamp>(rest + 1);
      samples.push_back(sample);
      coil = (coil + 1) % truth.coils.size();
    }
  }
  const std::vector<Sample> orientations =
      scenarios::orientationSamples(truth,
                                    scenarios::randomPoses(10, 0.5, generator),
                                    1e-3,
                                    scenarios::uniformStddev(1e-3),
                                    generator);
  samples.insert(samples.end(), orientations.begin(), orientations.end());
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n].id = static_cast<std::uint32_t>(n + 1);
  }
  return samples;
}

/// Each alone they would count far more than together.
TEST(SampleInfluence, KnowsWhatTheSamplesOfARestShare) {
  expectInfluencesOfLeavingOut(restsSamples(), {3, 40, 41, 77, 120, 195});
}

TEST(SampleInfluence, FindsTheOneBadSample) {
  std::vector<Sample> samples = paperSamples(2);
  samples[60].torque += Eigen::Vector3d::Constant(1.2e-3);
  const std::vector<SampleInfluence> influences = sampleInfluences(refined(samples));
  const auto worst = std::max_element(
      influences.begin(), influences.end(), [](const SampleInfluence& a, const SampleInfluence& b) {
        return a.largest_shift < b.largest_shift;
      });
  EXPECT_EQ(worst->id, samples[60].id);
  EXPECT_FALSE(worst->parameter.empty());
}

TEST(SampleInfluence, LeveragesSumUpToTheNumberOfParameters) {
  const std::vector<SampleInfluence> influences = sampleInfluences(refined(paperSamples(3)));
  double sum = 0.0;
  for (const SampleInfluence& influence : influences) {
    EXPECT_GE(influence.leverage, 0.0);
    EXPECT_LE(influence.leverage, 1.0 + 1e-9);
    sum += 3.0 * influence.leverage;
  }
  EXPECT_NEAR(sum, 73.0, 1e-6);
}

TEST(SampleInfluence, NamesTheSampleThatNothingReplaces) {
  std::vector<Sample> samples = paperSamples(4);
  const auto excites_coil_7 = [](const Sample& sample) {
    return sample.has_torque && sample.current[6] != 0.0;
  };
  const auto only = std::find_if(samples.begin(), samples.end(), excites_coil_7);
  const std::uint32_t only_id = only->id;
  samples.erase(std::remove_if(only + 1, samples.end(), excites_coil_7), samples.end());

  for (const SampleInfluence& influence : sampleInfluences(refined(samples))) {
    EXPECT_EQ(influence.irreplaceable, influence.id == only_id) << influence.id;
    EXPECT_LT(influence.largest_shift, 10.0) << influence.id;
    if (influence.irreplaceable) {
      EXPECT_EQ(influence.parameter.rfind("coil_7/", 0), 0U) << influence.parameter;
    }
  }
}

TEST(SampleInfluence, AMotionReplacesWhatASampleAloneTells) {
  MovingRotor moving;
  moving.truth = scenarios::paperTruth();
  std::vector<Sample> samples = paperSamples(4);
  const auto excites_coil_7 = [](const Sample& sample) {
    return sample.has_torque && sample.current[6] != 0.0;
  };
  const auto only = std::find_if(samples.begin(), samples.end(), excites_coil_7);
  samples.erase(std::remove_if(only + 1, samples.end(), excites_coil_7), samples.end());
  CalibrationSession session({scenarios::paperNominal()}, samples, {});
  session.setMotion(std::make_shared<const MotionRecording>(moving.record()));
  ASSERT_TRUE(session.run({Cycle::kMotion}).success);
  ASSERT_TRUE(session.run({Cycle::kRefine}).success) << session.reports().back().message;

  const std::vector<SampleInfluence> influences = sampleInfluences(session);
  EXPECT_GT(influences.size(), samples.size() / 2);
  for (const SampleInfluence& influence : influences) {
    EXPECT_FALSE(influence.irreplaceable) << influence.id << " " << influence.parameter;
    EXPECT_LT(influence.largest_shift, 10.0) << influence.id;
  }
}

TEST(SampleInfluence, AFailedCycleHasNone) {
  CalibrationSession session({scenarios::paperNominal()}, {}, {});
  session.run({Cycle::kRefine});
  EXPECT_TRUE(sampleInfluences(session).empty());
}

}  // namespace
}  // namespace sac
