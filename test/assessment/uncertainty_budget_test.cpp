#include "uncertainty_budget.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Calibrated with readings of joints that each dwell shares, and registrations known as well as
/// that [rad]: of tracker, marker and force/torque sensor.
CalibrationSession calibratedSession(double joint_stddev,
                                     const RegistrationUncertainty& registration,
                                     Cycle cycle) {
  scenarios::Generator generator(4);
  std::vector<Sample> samples =
      scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator);
  std::normal_distribution<double> normal;
  for (Sample& sample : samples) {
    sample.joint_stddev.setConstant(joint_stddev);
    for (double& q : sample.joint_position) {
      q += joint_stddev * normal(generator);
    }
    sample.torque_shared_stddev = 0.3 * sample.torque_stddev;
  }
  CalibrationConfig config;
  stateRegistration(config, registration);
  CalibrationSession session({scenarios::paperNominal()}, samples, config);
  session.run({cycle});
  return session;
}

CalibrationSession refinedSession(double joint_stddev, double marker) {
  return calibratedSession(joint_stddev, {0.0, marker, 0.0}, Cycle::kRefine);
}

double largestShare(const CalibrationSession& session, const std::string& source) {
  const std::vector<BudgetEntry> budget = uncertaintyBudget(session);
  const auto found = std::find_if(
      budget.begin(), budget.end(), [&](const auto& entry) { return entry.source == source; });
  return found == budget.end()
             ? 0.0
             : budgetShares(budget).col(std::distance(budget.begin(), found)).maxCoeff();
}

TEST(UncertaintyBudget, SumsUpToTheStatedVariances) {
  const CalibrationSession session = refinedSession(2e-4, 1e-3);
  ASSERT_TRUE(session.reports().back().success) << session.reports().back().message;
  const std::vector<BudgetEntry> budget = uncertaintyBudget(session);
  const std::vector<ParameterEstimate> parameters = session.parameters();
  ASSERT_GE(budget.size(), 5U);
  std::size_t compared = 0;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (!parameters[p].observable) {
      continue;
    }
    double variance = 0.0;
    for (const BudgetEntry& entry : budget) {
      variance += entry.variance[static_cast<Eigen::Index>(p)];
    }
    EXPECT_NEAR(std::sqrt(variance) / parameters[p].stddev, 1.0, 1e-3) << parameters[p].name;
    ++compared;
  }
  EXPECT_GT(compared, 60U);
}

TEST(UncertaintyBudget, FramesThatErrTogetherAreOneSource) {
  // What turns the tracker turns the marker the other way: the joints hardly feel both.
  FrameCovariance together = 1e-4 * FrameCovariance::Identity();
  const FrameCovariance apart = together;
  together.topRightCorner<3, 3>().diagonal().setConstant(-0.99e-4);
  together.bottomLeftCorner<3, 3>() = together.topRightCorner<3, 3>();
  const auto worst = [](const FrameCovariance& covariance) {
    const RegistrationUncertainty stated{std::nullopt, std::nullopt, 0.0, covariance};
    const CalibrationSession session = calibratedSession(0.0, stated, Cycle::kJoint);
    EXPECT_TRUE(session.reports().back().success) << session.reports().back().message;
    EXPECT_GT(largestShare(session, "frame_registration"), 0.9);
    EXPECT_EQ(largestShare(session, "marker_registration"), 0.0);
    double variance = 0.0;
    for (const ParameterEstimate& parameter : session.parameters()) {
      variance += parameter.observable ? parameter.stddev * parameter.stddev : 0.0;
    }
    return variance;
  };
  const CalibrationSession by_stddevs = calibratedSession(0.0, {0.01, 0.01, 0.0}, Cycle::kJoint);
  double variance = 0.0;
  for (const ParameterEstimate& parameter : by_stddevs.parameters()) {
    variance += parameter.observable ? parameter.stddev * parameter.stddev : 0.0;
  }
  EXPECT_NEAR(worst(apart) / variance, 1.0, 1e-6);
  EXPECT_GT(std::abs(worst(together) / variance - 1.0), 0.1);
}

TEST(UncertaintyBudget, NamesWhatLimits) {
  // Orientations alone take a turn of the marker for offsets of the joints.
  const CalibrationSession marker = calibratedSession(0.0, {0.0, 1e-2, 0.0}, Cycle::kJoint);
  EXPECT_GT(largestShare(marker, "marker_registration"), 0.9);
  EXPECT_EQ(largestShare(marker, "joint_reading"), 0.0);
  EXPECT_EQ(largestShare(marker, "tracker_registration"), 0.0);
  const CalibrationSession readings = refinedSession(1e-3, 0.0);
  EXPECT_GT(largestShare(readings, "joint_reading"), 0.5);
  EXPECT_EQ(largestShare(readings, "marker_registration"), 0.0);
}

TEST(UncertaintyBudget, HasSharesThatSumUpToOne) {
  const Eigen::MatrixXd shares =
      budgetShares(uncertaintyBudget(calibratedSession(2e-4, {1e-3, 1e-3, 1e-3}, Cycle::kRefine)));
  for (Eigen::Index p = 0; p < shares.rows(); ++p) {
    const double sum = shares.row(p).sum();
    EXPECT_TRUE(sum == 0.0 || std::abs(sum - 1.0) < 1e-12) << p;
    EXPECT_GE(shares.row(p).minCoeff(), 0.0) << p;
  }
}

TEST(UncertaintyBudget, IsEmptyWithoutAResult) {
  EXPECT_TRUE(uncertaintyBudget(CalibrationSession({scenarios::paperNominal()}, {}, {})).empty());
}

}  // namespace
}  // namespace sac
