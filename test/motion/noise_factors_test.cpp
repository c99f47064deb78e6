#include "noise_factors.hpp"

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "motion_terms.hpp"

namespace sac {
namespace {

constexpr Eigen::Index kValues = 18;
constexpr double kCurrentVariance = 4e-6;
constexpr NoiseFactors kChance{0.02, 0.005};

/// Windows whose residuals have the noise of these factors. Readings and currents act in directions
/// of their own in each.
std::vector<NoiseEvidence> windowsWith(const NoiseFactors& factors,
                                       std::size_t windows,
                                       unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const auto random = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd(
        Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine); }));
  };
  std::vector<NoiseEvidence> evidence;
  for (std::size_t n = 0; n < windows; ++n) {
    WindowBalance balance;
    const Eigen::MatrixXd joints = random(kValues, kValues);
    const Eigen::MatrixXd currents = random(kValues, kValues);
    balance.by_joints = joints * joints.transpose();
    balance.by_currents = currents * currents.transpose() / kCurrentVariance;
    balance.residual = std::sqrt(factors.joints) * joints * random(kValues, 1) +
                       std::sqrt(factors.currents) * currents * random(kValues, 1);
    // As it may have been left by what was found before.
    const Eigen::MatrixXd whitening =
        whiteningOfMany(0.7 * balance.by_joints + 0.4 * kCurrentVariance * balance.by_currents);
    evidence.push_back(
        noiseEvidence(balance, kCurrentVariance, whitening, whitening * balance.residual));
  }
  return evidence;
}

double reducedChiSquare(const std::vector<NoiseEvidence>& evidence, const NoiseFactors& factors) {
  double squares = 0.0;
  double count = 0.0;
  for (const NoiseEvidence& one : evidence) {
    squares +=
        (one.squares / (factors.joints * one.by_joints + factors.currents * one.by_currents)).sum();
    count += static_cast<double>(one.squares.size());
  }
  return squares / count;
}

TEST(NoiseEvidence, HasTheMisfitOfItsCovariance) {
  WindowBalance balance;
  balance.by_joints = Eigen::Vector2d(2.0, 1.0).asDiagonal();
  balance.by_currents = (Eigen::Matrix2d() << 3.0, 1.0, 1.0, 2.0).finished();
  const Eigen::Vector2d residual(0.3, -0.8);
  const double variance = 0.25;
  const Eigen::MatrixXd whitening =
      whiteningOfMany(2.0 * balance.by_joints + 5.0 * variance * balance.by_currents);
  const NoiseEvidence one = noiseEvidence(balance, variance, whitening, whitening * residual);
  const Eigen::Matrix2d covariance = 0.5 * balance.by_joints + 7.0 * variance * balance.by_currents;
  EXPECT_NEAR((one.squares / (0.5 * one.by_joints + 7.0 * one.by_currents)).sum(),
              residual.dot(covariance.inverse() * residual),
              1e-12);
}

TEST(NoiseFactors, AreThoseOfTheResiduals) {
  constexpr double kBound = 0.05;
  for (const NoiseFactors& made : {NoiseFactors{0.3, 0.6}, {1.0, 0.1}, {0.05, 1.0}, {0.6, 0.7}}) {
    const std::vector<NoiseEvidence> evidence = windowsWith(made, 400, 3);
    const NoiseFactors found = likelyFactors(evidence, kChance, 1.0);
    EXPECT_NEAR(found.joints / made.joints, 1.0, kBound) << made.joints << " " << made.currents;
    EXPECT_NEAR(found.currents / made.currents, 1.0, kBound) << made.joints << " " << made.currents;
    EXPECT_NEAR(reducedChiSquare(evidence, found), 1.0, 0.01);
  }
}

// By a part of the windows, as before, it would not.
TEST(NoiseFactors, LeaveTheMisfitOfManyWindowsThatOfNoise) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const std::vector<NoiseEvidence> evidence = windowsWith({0.8, 0.4}, 1200, seed);
    const NoiseFactors found = likelyFactors(evidence, kChance, 1.0);
    EXPECT_NEAR(reducedChiSquare(evidence, found), 1.0, 5e-3) << seed;
  }
}

TEST(NoiseFactors, RiseByWhatChanceHasMadeOfDifferencesAlone) {
  const NoiseFactors small = likelyFactors(windowsWith({1.02, 1.005}, 1200, 1), kChance, 1.0);
  EXPECT_NEAR(small.joints, 1.02, 0.02);
  EXPECT_NEAR(small.currents, 1.005, 0.01);
  const std::vector<NoiseEvidence> evidence = windowsWith({9.0, 9.0}, 400, 1);
  const NoiseFactors large = likelyFactors(evidence, kChance, 1.0);
  EXPECT_LE(large.joints, std::exp(3.0 * kChance.joints));
  EXPECT_LE(large.currents, std::exp(3.0 * kChance.currents));
  EXPECT_GT(reducedChiSquare(evidence, large), 8.0);
}

TEST(NoiseFactors, StayWhereFewWindowsDoubtThem) {
  const NoiseFactors found = likelyFactors(windowsWith({0.9, 1.0}, 8, 2), kChance, 1.0);
  EXPECT_NEAR(found.joints, 1.0, 3.0 * kChance.joints);
  EXPECT_NEAR(found.currents, 1.0, 3.0 * kChance.currents);
  const NoiseFactors nothing = likelyFactors({}, kChance, 1.0);
  EXPECT_EQ(nothing.joints, 1.0);
  EXPECT_EQ(nothing.currents, 1.0);
}

TEST(NoiseFactors, AreLikelierByWhatOthersFitWorse) {
  const std::vector<NoiseEvidence> evidence = windowsWith({0.3, 0.6}, 400, 3);
  const NoiseFactors found = likelyFactors(evidence, kChance, 1.0);
  EXPECT_EQ(likelierBy(found, found, evidence, kChance, 1.0), 0.0);
  EXPECT_GT(likelierBy(found, {}, evidence, kChance, 1.0), 100.0);
  EXPECT_LT(likelierBy({}, found, evidence, kChance, 1.0), -100.0);
  // As far off as chance makes it: a χ² of some 1.
  NoiseFactors near = found;
  near.currents *= 1.0 + 1.0 / std::sqrt(0.5 * 400.0 * kValues);
  EXPECT_LT(likelierBy(found, near, evidence, kChance, 1.0), 3.0);
}

}  // namespace
}  // namespace sac
