#include "weighted_observations.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Torques of one coil, weighed at the prior.
class KeptPass : public testing::Test {
 protected:
  KeptPass() {
    scenarios::Generator generator(1);
    samples_ = scenarios::torqueSamples(scenarios::paperTruth(),
                                        scenarios::randomPoses(40, 0.6, generator),
                                        0,
                                        2.0,
                                        5e-4,
                                        3e-4,
                                        generator);
    problem_.model = &model_;
    problem_.samples = &samples_;
    problem_.prior = nominalState(model_.space(), {}).belief;
    for (Eigen::Index p = 0; p < model_.space().size(); ++p) {
      problem_.free.push_back(p);
    }
    for (std::size_t n = 0; n < samples_.size(); ++n) {
      problem_.observations.push_back({n, Quantity::kTorque});
    }
  }
  Eigen::MatrixXd information(const WeightedObservations& observations) const {
    return observations.information(problem_.prior.x, problem_.free);
  }

  CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  std::vector<Sample> samples_;
  EstimationProblem problem_;
  const EstimationOptions options_;
  const std::vector<bool> none_held_ = std::vector<bool>(73, false);
  const std::vector<bool> all_held_ = std::vector<bool>(73, true);
};

TEST_F(KeptPass, IsForgottenWhenOtherObservationsServe) {
  WeightedObservations observations(problem_, options_);
  observations.updateWeights(problem_.prior.x, none_held_);
  const Eigen::MatrixXd of_all = information(observations);
  const WeightedObservations::Setting setting = observations.setting();
  for (std::size_t n = 0; n < 20; ++n) {
    observations.setActive(n, false);
  }
  const Eigen::MatrixXd of_half = information(observations);
  for (std::size_t n = 0; n < 40; ++n) {
    observations.setActive(n, n < 20);
  }
  EXPECT_LT((of_half + information(observations) - of_all).norm(), 1e-12 * of_all.norm());
  EXPECT_GT(of_half.norm(), 0.0);
  observations.activateAll();
  EXPECT_EQ(information(observations), of_all);
  observations.setActive(0, false);
  EXPECT_NE(information(observations), of_all);
  observations.restore(setting);
  EXPECT_EQ(information(observations), of_all);
}

TEST_F(KeptPass, IsForgottenWhenWeightsChange) {
  WeightedObservations observations(problem_, options_);
  observations.updateWeights(problem_.prior.x, none_held_);
  const double before = information(observations).norm();
  EXPECT_TRUE(observations.updateWeights(problem_.prior.x, all_held_));
  EXPECT_LT(information(observations).norm(), 0.5 * before);
}

TEST_F(KeptPass, IsOfItsOwnPoint) {
  WeightedObservations observations(problem_, options_);
  const Eigen::VectorXd truth = model_.space().coordinatesOf(scenarios::paperTruth());
  observations.updateWeights(problem_.prior.x, none_held_);
  const double at_prior = observations.chiSquare(problem_.prior.x);
  const double at_truth = observations.chiSquare(truth);
  observations.sum(truth);
  EXPECT_NEAR(observations.chiSquare(truth), at_truth, 1e-9 * at_truth);
  EXPECT_NEAR(observations.chiSquare(problem_.prior.x), at_prior, 1e-9 * at_prior);
  EXPECT_NEAR(observations.sum(truth).squaredMisfit(), at_truth, 1e-9 * at_truth);
  EXPECT_GT(at_prior, 10.0 * at_truth);
}

}  // namespace
}  // namespace sac
