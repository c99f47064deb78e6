#include "spherical_actuator_calibration/assessment/sample_influence.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
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

std::vector<SampleInfluence> influencesOf(const CalibrationSession& session) {
  return sampleInfluences(session.model(),
                          session.samples(),
                          session.reports().back(),
                          session.state(),
                          session.config().estimation);
}

TEST(SampleInfluence, IsWhatLeavingTheSampleOutDoes) {
  const std::vector<Sample> samples = paperSamples(1);
  const CalibrationSession session = refined(samples);
  const std::vector<SampleInfluence> influences = influencesOf(session);
  ASSERT_EQ(influences.size(), samples.size());
  for (const std::size_t left_out : {2U, 14U, 37U, 70U}) {
    std::vector<Sample> others = samples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const CalibrationSession without = refined(others);
    const Eigen::VectorXd stddevs = session.state().belief.covariance.diagonal().cwiseSqrt();
    const double shift = (without.state().belief.x - session.state().belief.x)
                             .cwiseAbs()
                             .cwiseQuotient(stddevs)
                             .maxCoeff();
    const SampleInfluence& told = influences[left_out];
    EXPECT_EQ(told.id, samples[left_out].id);
    EXPECT_NEAR(told.largest_shift, shift, 0.1 * shift + 0.02) << left_out;
  }
}

TEST(SampleInfluence, FindsTheOneBadSample) {
  std::vector<Sample> samples = paperSamples(2);
  samples[60].torque += Eigen::Vector3d::Constant(1.2e-3);
  const std::vector<SampleInfluence> influences = influencesOf(refined(samples));
  const auto worst = std::max_element(
      influences.begin(), influences.end(), [](const SampleInfluence& a, const SampleInfluence& b) {
        return a.largest_shift < b.largest_shift;
      });
  EXPECT_EQ(worst->id, samples[60].id);
  EXPECT_FALSE(worst->parameter.empty());
}

TEST(SampleInfluence, LeveragesSumUpToTheNumberOfParameters) {
  const std::vector<SampleInfluence> influences = influencesOf(refined(paperSamples(3)));
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

  for (const SampleInfluence& influence : influencesOf(refined(samples))) {
    EXPECT_EQ(influence.irreplaceable, influence.id == only_id) << influence.id;
    EXPECT_LT(influence.largest_shift, 10.0) << influence.id;
    if (influence.irreplaceable) {
      EXPECT_EQ(influence.parameter.rfind("coil_7/", 0), 0U) << influence.parameter;
    }
  }
}

TEST(SampleInfluence, AFailedCycleHasNone) {
  CalibrationSession session({scenarios::paperNominal()}, {}, {});
  session.run({Cycle::kRefine});
  EXPECT_TRUE(influencesOf(session).empty());
}

}  // namespace
}  // namespace sac
