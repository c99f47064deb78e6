#include "spherical_actuator_calibration/estimation/shared_errors.hpp"

#include <random>

#include <Eigen/LU>

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr Eigen::Index kDwellObservations = 5;
constexpr Eigen::Index kDwellUnknowns = 4;

/// A dwell with everything stacked, for comparison with what never is.
struct Stacked {
  Eigen::MatrixXd J = Eigen::MatrixXd(3 * kDwellObservations, kDwellUnknowns);
  Eigen::MatrixXd G = Eigen::MatrixXd(3 * kDwellObservations, kSharedErrors);
  Eigen::VectorXd r = Eigen::VectorXd(3 * kDwellObservations);

  explicit Stacked(std::uint64_t seed) {
    scenarios::Generator generator(seed);
    std::normal_distribution<double> normal(0.0, 2.0);
    const auto draw = [&](double /*unused*/) { return normal(generator); };
    J = J.unaryExpr(draw);
    G = G.unaryExpr(draw);
    r = r.unaryExpr(draw);
  }
  Eigen::MatrixXd weight() const {
    const Eigen::MatrixXd covariance =
        Eigen::MatrixXd::Identity(r.size(), r.size()) + G * G.transpose();
    return covariance.inverse();
  }
  WhitenedObservation observation(Eigen::Index n) const {
    WhitenedObservation result;
    result.residual = r.segment<3>(3 * n);
    result.columns = {0, 1, 2, 3};
    result.jacobian = J.middleRows<3>(3 * n);
    return result;
  }
  SharedLoading loading(Eigen::Index n) const { return G.middleRows<3>(3 * n); }
};

TEST(SharedErrors, EliminatedTheyLeaveWhatTheStackedCovarianceLeaves) {
  const Stacked stacked(1);
  DwellSum dwell(kDwellUnknowns);
  dwell.begin();
  for (Eigen::Index n = 0; n < kDwellObservations; ++n) {
    dwell.add(stacked.observation(n), stacked.loading(n));
  }
  InformationSum sum(kDwellUnknowns);
  dwell.addTo(sum);
  const Eigen::MatrixXd weight = stacked.weight();
  const Eigen::MatrixXd information = stacked.J.transpose() * weight * stacked.J;
  EXPECT_LT((sum.information() - information).norm(), 1e-9 * information.norm());
  EXPECT_LT((sum.gradient() - stacked.J.transpose() * weight * stacked.r).norm(), 1e-9);
  EXPECT_NEAR(sum.squaredMisfit(), stacked.r.dot(weight * stacked.r), 1e-9);
  EXPECT_NEAR(dwell.elimination().squaredMisfit(), sum.squaredMisfit(), 1e-9);
}

TEST(SharedErrors, TakenOutAnObservationLeavesTheOthers) {
  const Stacked stacked(2);
  DwellElimination all;
  DwellElimination others;
  for (Eigen::Index n = 0; n < kDwellObservations; ++n) {
    all.add(stacked.loading(n), stacked.observation(n).residual);
    if (n != 2) {
      others.add(stacked.loading(n), stacked.observation(n).residual);
    }
  }
  all.remove(stacked.loading(2), stacked.observation(2).residual);
  EXPECT_LT((all.errors() - others.errors()).norm(), 1e-9);
}

/// Three dwells of three torques each, readings as drawn.
std::vector<Sample> dwellSamples(double own_error) {
  scenarios::Generator generator(3);
  std::normal_distribution<double> normal(0.0, own_error);
  std::vector<Sample> samples;
  for (const Eigen::Vector3d& q : scenarios::randomPoses(3, 0.5, generator)) {
    for (std::size_t coil = 0; coil < 3; ++coil) {
      const Eigen::Vector3d reading =
          q + Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
      samples.push_back(scenarios::torqueSamples(
          scenarios::paperTruth(), {reading}, coil, 2.0, 1e-3, 1e-3, generator)[0]);
      samples.back().joint_stddev.setConstant(1e-3);
    }
  }
  return samples;
}

SharedErrorModel grouped(const std::vector<Sample>& samples, const EstimationOptions& options) {
  static const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  EstimationProblem problem;
  problem.model = &model;
  problem.samples = &samples;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    problem.observations.push_back({n, Quantity::kTorque});
  }
  return groupByDwell(problem, options);
}

TEST(SharedErrors, DwellsAreToldByReadingsThatAgree) {
  const SharedErrorModel model = grouped(dwellSamples(1e-5), {});
  ASSERT_EQ(model.dwells.size(), 3U);
  EXPECT_EQ(model.dwells[1], (std::vector<std::size_t>{3, 4, 5}));
}

TEST(SharedErrors, SamplesThatSayOfWhichDwellTheyAreNeedNoReadingsThatAgree) {
  std::vector<Sample> samples = dwellSamples(1.5e-3);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n].dwell = n < 6 ? 1 : 2;
    samples[n].torque_shared_stddev = 5e-4;
  }
  const SharedErrorModel model = grouped(samples, {});
  ASSERT_EQ(model.dwells.size(), 2U);
  EXPECT_EQ(model.dwells[0].size(), 6U);
  EXPECT_EQ(model.dwells[1], (std::vector<std::size_t>{6, 7, 8}));
}

TEST(SharedErrors, DwellsThatShareNothingAreNoGroups) {
  std::vector<Sample> samples = dwellSamples(1e-5);
  for (Sample& sample : samples) {
    sample.dwell = 1;
  }
  EXPECT_TRUE(grouped(samples, {}).dwells.empty());
}

TEST(SharedErrors, WhatIsSharedAndWhatIsOwnAreAllOfTheNoise) {
  std::vector<Sample> samples = dwellSamples(1e-5);
  samples[0].dwell = 1;
  samples[0].joint_shared_stddev = {4e-4, 0.0, 1e-3};
  samples[0].torque_shared_stddev = 3e-4;
  const CalibrationModel calibration_model{ParameterSpace(scenarios::paperNominal())};
  const Eigen::Index size = calibration_model.space().size();
  EstimationProblem problem;
  problem.model = &calibration_model;
  problem.samples = &samples;
  problem.observations = {{0, Quantity::kTorque}};
  problem.prior = {Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  const EstimationOptions options;
  const ObservationEvaluator evaluator(problem, options);
  LinearizedObservation linear;
  evaluator.linearize(0, evaluator.at(problem.prior.x), linear);
  const Eigen::Matrix<double, 3, 6> shared = evaluator.sharedErrors(0, linear);
  const Eigen::Matrix3d noise = evaluator.noise(0, linear);
  EXPECT_LT((evaluator.ownNoise(0, linear) + shared * shared.transpose() - noise).norm(),
            1e-12 * noise.norm());
  EXPECT_TRUE(shared.col(1).isZero(0.0));
  EXPECT_FALSE(shared.col(2).isZero(0.0));
}

TEST(SharedErrors, IndependentReadingsStayIndependent) {
  EXPECT_TRUE(grouped(dwellSamples(1.5e-3), {}).dwells.empty());
  EstimationOptions options;
  options.shared_errors = false;
  EXPECT_TRUE(grouped(dwellSamples(1e-5), options).dwells.empty());
}

}  // namespace
}  // namespace sac
