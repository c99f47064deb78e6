#include "spherical_actuator_calibration/estimation/least_squares.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"
#include "support/ceres_least_squares.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// One least-squares problem over the samples of a session.
class LeastSquares : public ::testing::Test {
 protected:
  void prepare(const CycleRequest& request, std::uint64_t seed) {
    scenarios::Generator generator(seed);
    const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.01, 0.01, generator);
    samples_ = scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
    problem_.model = &model_;
    problem_.samples = &samples_;
    problem_.observations = selectObservations(model_.space(), samples_, request, options_);
    problem_.free = selectCoordinates(model_.space(), samples_, request, options_);
    problem_.prior = nominalState(model_.space(), {}).belief;
    whitening_.assign(problem_.observations.size(),
                      Whitening(2000.0 * Eigen::Matrix3d::Identity()));
    evaluator_ = std::make_unique<ObservationEvaluator>(problem_, options_);
    input_.evaluator = evaluator_.get();
    input_.whitening = &whitening_;
    input_.active.assign(problem_.observations.size(), true);
    input_.free = problem_.free;
    input_.start = problem_.prior.x;
  }

  /// Distance from the minimum at which Ceres cannot tell it any more: it judges steps by the cost,
  /// δᵀNδ higher there, and the cost is rounded. With N = JᵀJ that is √(ε cost / λ_min). A prior of
  /// a hundredth of the noise of an observation makes it ill-conditioned, and the rounding is the
  /// processor's: some hundredfold of the coordinates', magnified by the condition of J, adds to
  /// it.
  double resolution(const Eigen::VectorXd& x) const {
    constexpr double kRounding = std::numeric_limits<double>::epsilon();
    const ChosenCoordinates chosen(x.size(), input_.free);
    InformationSum sum(chosen.size());
    const ModelPoint point = evaluator_->at(x);
    LinearizedObservation linear;
    WhitenedObservation whitened;
    for (std::size_t n = 0; n < input_.active.size(); ++n) {
      if (input_.active[n]) {
        evaluator_->linearize(n, point, linear);
        whiten(linear, whitening_[n], chosen, whitened);
        sum.add(whitened);
      }
    }
    Eigen::MatrixXd information = sum.information();
    if (input_.prior.directions.cols() > 0) {
      const Eigen::MatrixXd directions = input_.prior.directions(input_.free, Eigen::all);
      information += directions * input_.prior.covariance.inverse() * directions.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(information);
    const double least = spectrum.eigenvalues()[0];
    const double condition = std::sqrt(spectrum.eigenvalues()[chosen.size() - 1] / least);
    return std::sqrt(10.0 * kRounding * sum.squaredMisfit() / least) +
           100.0 * kRounding * condition * x.norm();
  }

  void expectTheSameMinimum() const {
    const LeastSquaresResult ceres = solveWithCeres(input_);
    const LeastSquaresResult own = solveLeastSquares(input_);
    ASSERT_EQ(ceres.termination, Termination::kConverged);
    ASSERT_EQ(own.termination, Termination::kConverged);
    EXPECT_GT((ceres.solution() - input_.start).norm(), 1e-2);
    const double tolerance = resolution(own.solution());
    EXPECT_LT(tolerance, 1e-6);
    EXPECT_LT((ceres.solution() - own.solution()).cwiseAbs().maxCoeff(), tolerance);
  }

  CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  EstimationOptions options_;
  std::vector<Sample> samples_;
  EstimationProblem problem_;
  std::vector<Whitening> whitening_;
  std::unique_ptr<ObservationEvaluator> evaluator_;
  LeastSquaresInput input_;
};

TEST_F(LeastSquares, FindsTheMinimumThatCeresFinds) {
  for (const Cycle cycle : {Cycle::kJoint, Cycle::kRefine}) {
    prepare({cycle}, 1);
    expectTheSameMinimum();
  }
}

TEST_F(LeastSquares, WeighsMisfitsByTheLoss) {
  prepare({Cycle::kJoint}, 2);
  samples_[3].R_stator_rotor = samples_[4].R_stator_rotor;
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy}) {
    input_.loss = loss;
    input_.loss_transition = 4.0;
    expectTheSameMinimum();
  }
}

TEST_F(LeastSquares, LeavesOutWhatIsNotActiveOrFree) {
  prepare({Cycle::kRefine}, 3);
  samples_[20].torque *= 5.0;
  for (std::size_t n = 0; n < problem_.observations.size(); ++n) {
    input_.active[n] = problem_.observations[n].sample != 20;
  }
  input_.free.erase(input_.free.begin() + 4);
  expectTheSameMinimum();
  EXPECT_EQ(solveLeastSquares(input_).solution()[4], input_.start[4]);
}

TEST_F(LeastSquares, CountsThePrior) {
  prepare({Cycle::kRefine}, 4);
  input_.prior.directions = Eigen::MatrixXd::Zero(model_.space().size(), 2);
  input_.prior.directions(0, 0) = 1.0;
  input_.prior.directions(30, 1) = 1.0;
  input_.prior.mean = Eigen::Vector2d(0.003, -0.002);
  input_.prior.covariance = Eigen::Vector2d(1e-10, 1e-10).asDiagonal();
  expectTheSameMinimum();
  EXPECT_NEAR(solveLeastSquares(input_).solution()[0], 0.003, 1e-3);
}

TEST_F(LeastSquares, StaysWhereNothingIsLeftToGo) {
  prepare({Cycle::kRefine}, 6);
  input_.start = solveLeastSquares(input_).solution();
  const LeastSquaresResult again = solveLeastSquares(input_);
  EXPECT_EQ(again.termination, Termination::kConverged);
  EXPECT_LT((again.solution() - input_.start).cwiseAbs().maxCoeff(), resolution(input_.start));
  EXPECT_LE(again.path.size(), 3U);
}

TEST_F(LeastSquares, WithoutNoiseFindsTheTruthAndStaysThere) {
  prepare({Cycle::kRefine}, 7);
  const Eigen::VectorXd truth = solveLeastSquares(input_).solution();
  const ModelPoint point(model_, truth);
  for (Sample& sample : samples_) {
    predictMeasurements(point, sample);
  }
  const LeastSquaresResult found = solveLeastSquares(input_);
  ASSERT_EQ(found.termination, Termination::kConverged);
  EXPECT_LT((found.solution() - truth).cwiseAbs().maxCoeff(), 1e-12);
  input_.start = truth;
  const LeastSquaresResult stayed = solveLeastSquares(input_);
  ASSERT_EQ(stayed.termination, Termination::kConverged);
  EXPECT_LT((stayed.solution() - truth).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(LeastSquares, StopsAtTheLimitOfIterations) {
  prepare({Cycle::kRefine}, 5);
  input_.max_iterations = 2;
  const LeastSquaresResult result = solveLeastSquares(input_);
  EXPECT_EQ(result.termination, Termination::kIterationLimit);
  EXPECT_EQ(result.path.size(), 3U);
}

}  // namespace
}  // namespace sac
