#include "spherical_actuator_calibration/assessment/torque_linearity.hpp"

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kFull = 2.0;            // [A]
constexpr double kCurrentStddev = 5e-4;  // [A] of a measured current

/// [N·m] at full current, in proportion.
Eigen::Vector3d perShare() {
  return {0.31, -0.22, 0.12};
}

/// A coil whose torque bends, in one rest.
struct Bench {
  double deviation = 0.0;
  double asymmetry = 0.0;
  double torque_stddev = 5e-5;
  double shared_stddev = 3e-5;
  Eigen::Vector3d not_taken_off = Eigen::Vector3d::Zero();
  std::vector<double> currents{kFull, 0.5 * kFull, -kFull};

  Eigen::Vector3d torqueAt(double current) const {
    const double share = current / kFull;
    return perShare() * share * (1.0 + deviation * std::abs(share) + asymmetry * share) +
           not_taken_off;
  }

  Sample sampleAt(double current) const {
    Sample sample;
    sample.dwell = 7;
    sample.has_torque = true;
    sample.current = Eigen::VectorXd::Zero(4);
    sample.current[2] = current;
    sample.torque = torqueAt(current);
    sample.torque_shared_stddev = shared_stddev;
    sample.torque_stddev = std::hypot(torque_stddev, shared_stddev);
    return sample;
  }

  std::vector<Sample> samples() const {
    std::vector<Sample> samples;
    for (const double current : currents) {
      samples.push_back(sampleAt(current));
      samples.back().id = 10 + static_cast<std::uint32_t>(samples.size());
    }
    return samples;
  }
};

std::optional<TorqueLinearity> judged(const std::vector<Sample>& samples) {
  return torqueLinearity(samples, {});
}

TEST(TorqueLinearity, FindsWhatATorqueDeviatesByWithoutNoise) {
  const auto found = judged(Bench{-0.02, 0.005}.samples());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->coil, 2U);
  EXPECT_EQ(found->samples, (std::vector<std::uint32_t>{11, 12, 13}));
  EXPECT_EQ(found->full_current, kFull);
  // What is expected beforehand, 0 ± 1, draws by a millionth.
  EXPECT_NEAR(found->deviation.value, -0.02, 1e-6);
  EXPECT_LT(found->deviation.stddev, 2e-3);
  ASSERT_TRUE(found->asymmetry);
  EXPECT_NEAR(found->asymmetry->value, 0.005, 1e-6);
  EXPECT_FALSE(found->isProportional());
  EXPECT_GT(found->law_probability, 0.99);
}

TEST(TorqueLinearity, AccusesNoTorqueInProportion) {
  const auto found = judged(Bench{}.samples());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->deviation.value, 0.0, 1e-9);
  EXPECT_EQ(found->degrees_of_freedom, 6);
  EXPECT_TRUE(found->isProportional());
}

/// Samples with errors of all kinds that are stated, and of the measured current.
std::vector<Sample> noisy(const Bench& bench, double current_stddev, std::mt19937_64& generator) {
  std::normal_distribution<double> unit;
  const auto vector = [&](double stddev) {
    return Eigen::Vector3d(
        stddev * unit(generator), stddev * unit(generator), stddev * unit(generator));
  };
  std::vector<Sample> samples = bench.samples();
  const Eigen::Vector3d shared = vector(bench.shared_stddev);
  for (Sample& sample : samples) {
    sample.torque += shared + vector(bench.torque_stddev);
    sample.current[2] += current_stddev * unit(generator);
  }
  return samples;
}

TEST(TorqueLinearity, IsRightWithinItsOwnUncertainty) {
  constexpr int kTrials = 2000;
  const Bench bench{-0.02, 0.004};
  std::mt19937_64 generator(3);
  int deviations = 0;
  int asymmetries = 0;
  int lawless = 0;
  for (int n = 0; n < kTrials; ++n) {
    const auto found = judged(noisy(bench, kCurrentStddev, generator));
    ASSERT_TRUE(found && found->asymmetry);
    deviations += std::abs(found->deviation.value + 0.02) < 1.96 * found->deviation.stddev ? 1 : 0;
    asymmetries +=
        std::abs(found->asymmetry->value - 0.004) < 1.96 * found->asymmetry->stddev ? 1 : 0;
    lawless += found->law_probability < 0.01 ? 1 : 0;
  }
  // A misfit widens what is told, never narrows it: some more than 95 %.
  EXPECT_GE(deviations, static_cast<int>(0.945 * kTrials));
  EXPECT_GE(asymmetries, static_cast<int>(0.945 * kTrials));
  EXPECT_LT(deviations, static_cast<int>(0.985 * kTrials));
  EXPECT_NEAR(lawless, 0.01 * kTrials, 15);
}

TEST(TorqueLinearity, ItsProbabilityIsOneOfChance) {
  constexpr int kTrials = 2000;
  std::mt19937_64 generator(4);
  int improbable = 0;
  for (int n = 0; n < kTrials; ++n) {
    const auto found = judged(noisy(Bench{}, kCurrentStddev, generator));
    ASSERT_TRUE(found);
    improbable += found->probability < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(improbable, 0.05 * kTrials, 35);
}

TEST(TorqueLinearity, IsNotToldByTwoCurrents) {
  Bench bench;
  bench.currents = {kFull, 0.5 * kFull};
  EXPECT_FALSE(judged(bench.samples()));
  bench.currents = {kFull, 0.5 * kFull, 0.5 * kFull, kFull};
  EXPECT_FALSE(judged(bench.samples()));
  bench.currents = {kFull, -kFull, kFull};
  EXPECT_FALSE(judged(bench.samples()));
  EXPECT_NE(describe(judged(bench.samples())).find("is not told: measure one coil at three"),
            std::string::npos);
}

TEST(TorqueLinearity, IsNotToldByDifferentRestsOrCoils) {
  std::vector<Sample> samples = Bench{}.samples();
  samples[1].dwell = 8;
  EXPECT_FALSE(judged(samples));
  samples = Bench{}.samples();
  samples[1].current[0] = 1.0;
  EXPECT_FALSE(judged(samples));
}

TEST(TorqueLinearity, IsNotToldByACoilThatMakesHardlyAnyTorque) {
  Bench bench;
  bench.torque_stddev = 0.1;
  EXPECT_FALSE(judged(bench.samples()));
}

TEST(TorqueLinearity, TakesATorqueThatWasNotTakenOffForNoDeviation) {
  Bench bench{-0.02};
  bench.not_taken_off = {0.01, 0.02, -0.03};
  bench.shared_stddev = 0.0;
  EXPECT_FALSE(judged(bench.samples()));
  bench.currents.push_back(0.0);
  const auto found = judged(bench.samples());
  ASSERT_TRUE(found && found->asymmetry);
  EXPECT_NEAR(found->deviation.value, -0.02, 1e-4);
  EXPECT_NEAR(found->asymmetry->value, 0.0, 1e-4);
  EXPECT_EQ(found->degrees_of_freedom, 6);
}

TEST(TorqueLinearity, DoesNotTakeInAgainWhatWasTakenOff) {
  const Bench bench{-0.02};
  std::vector<Sample> samples = bench.samples();
  // As a node holds it: the sample without current has the bias that others are without.
  Sample without = bench.sampleAt(0.0);
  without.torque << 0.01, 0.02, -0.03;
  without.torque_stddev = bench.shared_stddev;
  without.torque_shared_stddev = 0.0;
  samples.insert(samples.begin(), without);
  const auto found = judged(samples);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->samples.size(), 3U);
  EXPECT_NEAR(found->deviation.value, -0.02, 1e-6);
}

TEST(TorqueLinearity, TellsATorqueThatFollowsNoLaw) {
  std::vector<Sample> samples = Bench{}.samples();
  samples[1].torque += Eigen::Vector3d(0.0, 0.0, 0.01);
  const auto found = judged(samples);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->isProportional());
  EXPECT_NE(describe(found).find("follow no such law"), std::string::npos) << describe(found);
}

TEST(TorqueLinearity, ComesWithItsUncertaintyInWords) {
  const std::string text = describe(judged(Bench{-0.02}.samples()));
  EXPECT_EQ(text.find("Torque is not proportional to current: coil 3 at 2.00, 1.00, -2.00 A "
                      "deviates by -2.0"),
            0U)
      << text;
  EXPECT_NE(text.find(" ± 0."), std::string::npos) << text;
  EXPECT_NE(text.find(" % at 2.00 A, a positive current by "), std::string::npos) << text;
  EXPECT_EQ(describe(judged(Bench{}.samples())).find("Torque is proportional to current: "), 0U);
}

/// Rests of several coils, some of which the last sample changes, and some that tell nothing.
TEST(TorqueLinearity, IsFoundAsSamplesComeAsInAllOfThem) {
  std::mt19937_64 generator(6);
  std::vector<Sample> samples;
  for (int rest = 0; rest < 12; ++rest) {
    Bench bench{-0.02};
    bench.torque_stddev *= 1.0 + (rest * 5 % 7);
    bench.shared_stddev *= rest % 3 == 0 ? 0.0 : 1.0;
    bench.currents.push_back(0.0);
    for (Sample sample : noisy(bench, 0.0, generator)) {
      sample.dwell = 100 + rest;
      sample.id = static_cast<std::uint32_t>(samples.size() + 1);
      samples.push_back(sample);
      sample.current[1] = std::exchange(sample.current[2], 0.0);
      samples.push_back(sample);
    }
  }
  LinearitySearch search{EstimationOptions()};
  std::vector<Sample> so_far;
  for (const Sample& sample : samples) {
    so_far.push_back(sample);
    search.add(sample);
    const auto found = search.best();
    const auto expected = judged(so_far);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (found) {
      EXPECT_EQ(found->samples, expected->samples);
      EXPECT_EQ(found->coil, expected->coil);
      EXPECT_EQ(found->deviation.value, expected->deviation.value);
    }
  }
  EXPECT_TRUE(search.best());
}

}  // namespace
}  // namespace sac
