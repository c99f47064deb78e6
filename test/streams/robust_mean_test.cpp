#include "robust_mean.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace sac {
namespace {

using Generator = std::mt19937_64;

constexpr RobustMean::Options kOptions{6.0, 0.0};

Eigen::Vector3d normal(Generator& generator) {
  std::normal_distribution<double> distribution;
  return {distribution(generator), distribution(generator), distribution(generator)};
}

/// Share of the components whose mean lies within 1.96 standard deviations of the truth, for
/// series with x_i = memory · x_{i−1} + noise.
double coverage(double memory, std::size_t count) {
  int inside = 0;
  constexpr int kTrials = 1000;
  for (int trial = 0; trial < kTrials; ++trial) {
    Generator generator(static_cast<std::uint64_t>(trial));
    RobustMean mean(kOptions);
    Eigen::Vector3d deviation = normal(generator) / std::sqrt(1.0 - memory * memory);
    for (std::size_t i = 0; i < count; ++i) {
      mean.add(Eigen::Vector3d(1.0, 2.0, 3.0) + deviation);
      deviation = memory * deviation + normal(generator);
    }
    const MeanEstimate estimate = mean.estimate();
    const Eigen::Array3d error = (estimate.mean - Eigen::Vector3d(1.0, 2.0, 3.0)).array().abs();
    inside += static_cast<int>((error <= 1.96 * estimate.variance.array().sqrt()).count());
  }
  return inside / (3.0 * kTrials);
}

TEST(RobustMean, HoldsTheTruthAsOftenAsStated) {
  EXPECT_NEAR(coverage(0.0, 100), 0.95, 0.015);
  EXPECT_NEAR(coverage(0.0, 1000), 0.95, 0.015);
}

TEST(RobustMean, AllowsForCorrelatedNoise) {
  // Without the correction it would be 0.74 and 0.51.
  EXPECT_NEAR(coverage(0.5, 300), 0.95, 0.02);
  EXPECT_NEAR(coverage(0.8, 300), 0.95, 0.03);
}

TEST(RobustMean, IsNeverBetterThanForIndependentNoise) {
  RobustMean mean(kOptions);
  for (int i = 0; i < 100; ++i) {
    mean.add(Eigen::Vector3d::Constant(i % 2 == 0 ? 1.0 : -1.0));
  }
  EXPECT_NEAR(mean.estimate().variance.x(), 1.0 / 99.0, 1e-15);
}

TEST(RobustMean, LeavesGlitchesOut) {
  Generator generator(3);
  RobustMean clean(kOptions);
  RobustMean disturbed(kOptions);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d value = normal(generator);
    clean.add(value);
    disturbed.add(value);
    if (i % 50 == 7) {
      disturbed.add(value + Eigen::Vector3d(0.0, 100.0, 0.0));
    }
  }
  const MeanEstimate expected = clean.estimate();
  const MeanEstimate estimate = disturbed.estimate();
  EXPECT_EQ(expected.glitches, 0U);
  EXPECT_EQ(estimate.glitches, 4U);
  EXPECT_EQ(estimate.count, 200U);
  EXPECT_EQ(estimate.mean, expected.mean);
  EXPECT_EQ(estimate.variance, expected.variance);
}

TEST(RobustMean, TakesNoQuantumForAGlitch) {
  RobustMean mean(kOptions);
  for (int i = 0; i < 100; ++i) {
    mean.add(Eigen::Vector3d::Constant(i % 5 == 0 ? 1.0 : 0.0));
  }
  const MeanEstimate estimate = mean.estimate();
  EXPECT_EQ(estimate.glitches, 0U);
  EXPECT_NEAR(estimate.mean.x(), 0.2, 1e-15);
}

TEST(RobustMean, FindsTheGlitchAmongEqualValues) {
  RobustMean mean(kOptions);
  for (int i = 0; i < 100; ++i) {
    mean.add(Eigen::Vector3d::Constant(i == 40 ? 1.0 : 0.0));
  }
  const MeanEstimate estimate = mean.estimate();
  EXPECT_EQ(estimate.glitches, 1U);
  EXPECT_EQ(estimate.mean, Eigen::Vector3d::Zero());
  EXPECT_EQ(estimate.variance, Eigen::Vector3d::Zero());
}

TEST(RobustMean, TheSmallestScaleKeepsRareQuanta) {
  RobustMean mean({6.0, 0.2});
  for (int i = 0; i < 100; ++i) {
    mean.add(Eigen::Vector3d::Constant(i == 40 ? 1.0 : 0.0));
  }
  EXPECT_EQ(mean.estimate().glitches, 0U);
}

TEST(RobustMean, TellsDriftFromNoise) {
  Generator generator(4);
  RobustMean still(kOptions);
  RobustMean drifting(kOptions);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d noise = normal(generator);
    still.add(noise);
    drifting.add(noise + Eigen::Vector3d(3.0 * i / 300.0, 0.0, 0.0));
  }
  const MeanEstimate rest = still.estimate();
  EXPECT_TRUE((rest.drift.array() < 4.0 * rest.drift_stddev.array()).all());
  // Two thirds of the whole change lie between the first and the last third.
  const MeanEstimate drift = drifting.estimate();
  EXPECT_NEAR(drift.drift.x(), 2.0, 0.5);
  EXPECT_NEAR(drift.drift_stddev.x(), std::sqrt(2.0 / 100.0), 0.02);
  EXPECT_GT(drift.drift.x(), 4.0 * drift.drift_stddev.x());
}

TEST(RobustMean, AverageOfOneMeasurementIsItself) {
  RobustMean mean(kOptions);
  mean.add(Eigen::Vector3d(1.0, -2.0, 3.0));
  const MeanEstimate estimate = mean.estimate();
  EXPECT_EQ(estimate.mean, Eigen::Vector3d(1.0, -2.0, 3.0));
  EXPECT_EQ(estimate.count, 1U);
}

}  // namespace
}  // namespace sac
