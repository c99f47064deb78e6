#include "accumulated_least_squares.hpp"

#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// One least-squares problem over the samples of a session: few enough for Ceres.
class AccumulatedLeastSquares : public ::testing::Test {
 protected:
  void prepare(const CycleRequest& request, std::uint64_t seed) {
    scenarios::Generator generator(seed);
    const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.01, 0.01, generator);
    samples_ = scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
    problem_.model = &model_;
    problem_.samples = &samples_;
    problem_.observations = selectObservations(samples_, request, options_);
    problem_.free = selectCoordinates(model_.space(), samples_, request, options_);
    problem_.prior = nominalState(model_.space(), {}).belief;
    whitening_.assign(problem_.observations.size(), 2000.0 * Eigen::Matrix3d::Identity());
    evaluator_ = std::make_unique<ObservationEvaluator>(problem_, options_);
    input_.problem = &problem_;
    input_.evaluator = evaluator_.get();
    input_.whitening = &whitening_;
    input_.active.assign(problem_.observations.size(), true);
    input_.free.assign(static_cast<std::size_t>(model_.space().size()), false);
    for (const Eigen::Index p : problem_.free) {
      input_.free[static_cast<std::size_t>(p)] = true;
    }
    input_.start = problem_.prior.x;
  }

  void expectTheSameMinimum(double tolerance) const {
    const LeastSquaresResult ceres = solveLeastSquares(input_);
    const LeastSquaresResult accumulated = solveAccumulatedLeastSquares(input_);
    ASSERT_EQ(ceres.termination, Termination::kConverged);
    ASSERT_EQ(accumulated.termination, Termination::kConverged);
    EXPECT_GT((ceres.solution() - input_.start).norm(), 1e-2);
    EXPECT_LT((ceres.solution() - accumulated.solution()).cwiseAbs().maxCoeff(), tolerance);
  }

  CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  EstimationOptions options_;
  std::vector<Sample> samples_;
  EstimationProblem problem_;
  std::vector<Eigen::Matrix3d> whitening_;
  std::unique_ptr<ObservationEvaluator> evaluator_;
  LeastSquaresInput input_;
};

TEST_F(AccumulatedLeastSquares, FindsTheMinimumThatCeresFinds) {
  for (const Cycle cycle : {Cycle::kJoint, Cycle::kRefine}) {
    prepare({cycle}, 1);
    expectTheSameMinimum(1e-10);
  }
}

TEST_F(AccumulatedLeastSquares, WeighsMisfitsByTheLoss) {
  prepare({Cycle::kJoint}, 2);
  samples_[3].R_stator_rotor = samples_[4].R_stator_rotor;
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy}) {
    input_.loss = loss;
    input_.loss_transition = 4.0;
    expectTheSameMinimum(1e-8);
  }
}

TEST_F(AccumulatedLeastSquares, LeavesOutWhatIsNotActiveOrFree) {
  prepare({Cycle::kRefine}, 3);
  samples_[20].torque *= 5.0;
  for (std::size_t n = 0; n < problem_.observations.size(); ++n) {
    input_.active[n] = problem_.observations[n].sample != 20;
  }
  input_.free[4] = false;
  expectTheSameMinimum(1e-9);
  EXPECT_EQ(solveAccumulatedLeastSquares(input_).solution()[4], input_.start[4]);
}

TEST_F(AccumulatedLeastSquares, CountsThePrior) {
  prepare({Cycle::kRefine}, 4);
  input_.prior.directions = Eigen::MatrixXd::Zero(model_.space().size(), 2);
  input_.prior.directions(0, 0) = 1.0;
  input_.prior.directions(30, 1) = 1.0;
  input_.prior.mean = Eigen::Vector2d(0.003, -0.002);
  input_.prior.covariance = Eigen::Vector2d(1e-10, 1e-10).asDiagonal();
  expectTheSameMinimum(1e-10);
  EXPECT_NEAR(solveAccumulatedLeastSquares(input_).solution()[0], 0.003, 1e-3);
}

TEST_F(AccumulatedLeastSquares, StopsAtTheLimitOfIterations) {
  prepare({Cycle::kRefine}, 5);
  input_.max_iterations = 2;
  const LeastSquaresResult result = solveAccumulatedLeastSquares(input_);
  EXPECT_EQ(result.termination, Termination::kIterationLimit);
  EXPECT_EQ(result.path.size(), 3U);
}

}  // namespace
}  // namespace sac
