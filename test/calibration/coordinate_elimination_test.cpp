#include "coordinate_elimination.hpp"

#include <numeric>
#include <random>
#include <vector>

#include <Eigen/LU>

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Coordinates of the paper's actuator, of which observations tell something at random.
class CoordinateEliminationTest : public ::testing::Test {
 protected:
  CoordinateEliminationTest() {
    problem_.model = &model_;
    problem_.prior = {Eigen::VectorXd::Zero(size_), Eigen::MatrixXd::Zero(size_, size_)};
    estimate_.belief = problem_.prior;
    WhitenedObservation one;
    one.columns.resize(static_cast<std::size_t>(size_));
    std::iota(one.columns.begin(), one.columns.end(), 0);
    for (int n = 0; n < 40; ++n) {
      one.residual = random(3, 1);
      one.jacobian = random(3, size_);
      sum_.add(one);
    }
  }

  Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal_(generator_); });
  }
  void holdFirst(Eigen::Index count) {
    problem_.free.resize(static_cast<std::size_t>(size_ - count));
    std::iota(problem_.free.begin(), problem_.free.end(), count);
  }
  /// (N + K⁻¹)⁻¹ with K what is known beside the observations, in a form for which K may have no
  /// inverse.
  Eigen::MatrixXd covariance() const {
    Eigen::MatrixXd known = problem_.prior.covariance;
    for (const Eigen::Index p : problem_.free) {
      known(p, p) = options_.unobservable_stddev * options_.unobservable_stddev;
    }
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(size_, size_);
    return (identity + known * sum_.information()).lu().solve(known);
  }
  void expectThatOfTheCovariance() {
    const CoordinateElimination elimination(problem_, estimate_, options_, sum_);
    const Eigen::MatrixXd all = covariance();
    const Eigen::VectorXd a = random(size_, 1);
    const Eigen::MatrixXd both = random(size_, 2);
    const Eigen::MatrixXd halves = elimination.half(both);
    const Eigen::MatrixXd expected = both.transpose() * all * both;
    EXPECT_LT((halves.transpose() * halves - expected).norm(), 1e-10);
    const Eigen::VectorXd of_gradient = halves.transpose() * elimination.halfGradient();
    EXPECT_LT((of_gradient - both.transpose() * all * sum_.gradient()).norm(), 1e-10);
    EXPECT_LT((elimination.covarianceTimes(a) - all * a).norm(), 1e-10);
  }

  std::mt19937 generator_{2};
  std::normal_distribution<double> normal_;
  CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  Eigen::Index size_ = model_.space().size();
  ScoreSum sum_{size_, {}};
  EstimationProblem problem_;
  Estimate estimate_;
  EstimationOptions options_;
};

TEST_F(CoordinateEliminationTest, OfFreeCoordinatesIsByTheirCovariance) {
  holdFirst(0);
  expectThatOfTheCovariance();
}

TEST_F(CoordinateEliminationTest, CountsHeldCoordinatesByWhatIsKnownOfThem) {
  holdFirst(9);
  const Eigen::MatrixXd root = 0.1 * random(9, 9);
  problem_.prior.covariance.topLeftCorner(9, 9) = root * root.transpose();
  expectThatOfTheCovariance();
}

TEST_F(CoordinateEliminationTest, KnowsHeldCoordinatesThatAreCertainInSomeDirections) {
  holdFirst(9);
  const Eigen::MatrixXd root = 0.1 * random(9, 4);
  problem_.prior.covariance.topLeftCorner(9, 9) = root * root.transpose();
  expectThatOfTheCovariance();
}

}  // namespace
}  // namespace sac
