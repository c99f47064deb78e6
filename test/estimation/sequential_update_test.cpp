#include "spherical_actuator_calibration/estimation/sequential_update.hpp"

#include <cstdint>
#include <random>
#include <utility>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "estimation/random_matrix.hpp"

namespace sac {
namespace {

constexpr Eigen::Index kFew = 9;     // coordinates
constexpr Eigen::Index kMany = 300;  // of which the covariance waits
constexpr Eigen::Index kObservations = 23;
constexpr Eigen::Index kOfDwell = 3;  // observations of each dwell; the last one has fewer

/// Residuals that depend on some of the coordinates each, and on errors of their dwells, with a
/// prior of any rank.
class SequentialUpdateTest : public testing::TestWithParam<std::pair<Eigen::Index, Eigen::Index>> {
 protected:
  void SetUp() override {
    std::mt19937_64 generator(3);
    const auto [coordinates, rank] = GetParam();
    const Eigen::MatrixXd root = randomMatrix(coordinates, rank, generator);
    P_ = root * root.transpose() / static_cast<double>(coordinates);
    r_ = randomMatrix(3 * kObservations, 1, generator);
    J_ = Eigen::MatrixXd::Zero(3 * kObservations, coordinates);
    S_ = Eigen::MatrixXd::Identity(3 * kObservations, 3 * kObservations);
    SequentialUpdate update(P_);
    for (Eigen::Index n = 0; n < kObservations; ++n) {
      if (n % kOfDwell == 0) {
        update.beginDwell();
        dwell_.setZero(3 * kObservations, kSharedErrors);
      }
      observe(n, generator, update);
      if (n == 4) {
        update.settle();
      }
    }
    S_ += J_ * P_ * J_.transpose();
    chi_square_ = update.chiSquare();
    mean_ = update.mean();
    covariance_ = update.covariance();
  }

  void observe(Eigen::Index n, std::mt19937_64& generator, SequentialUpdate& update) {
    WhitenedObservation observation;
    observation.columns = {n % 3, 4, 5 + n % 4};
    observation.jacobian = randomMatrix(3, 3, generator);
    observation.residual = r_.segment<3>(3 * n);
    for (std::size_t k = 0; k < 3; ++k) {
      J_.block<3, 1>(3 * n, observation.columns[k]) =
          observation.jacobian.col(static_cast<Eigen::Index>(k));
    }
    const SharedLoading loading = randomMatrix(3, kSharedErrors, generator);
    // Covariance with those of the same dwell so far, and of its own.
    S_.middleRows<3>(3 * n) += loading * dwell_.transpose();
    S_.middleCols<3>(3 * n) += dwell_ * loading.transpose();
    S_.block<3, 3>(3 * n, 3 * n) += loading * loading.transpose();
    dwell_.middleRows<3>(3 * n) = loading;
    update.observe(observation, loading);
  }

  Eigen::MatrixXd P_;
  Eigen::MatrixXd J_;
  Eigen::VectorXd r_;
  Eigen::MatrixXd S_;  ///< covariance of all residuals
  Eigen::MatrixXd dwell_;
  double chi_square_ = 0.0;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

TEST_P(SequentialUpdateTest, HasTheSquaredMahalanobisNormOfAllResiduals) {
  EXPECT_NEAR(chi_square_, r_.dot(S_.llt().solve(r_)), 1e-9);
}

TEST_P(SequentialUpdateTest, IsTheEstimateOfAllAtOnce) {
  const Eigen::MatrixXd gain = P_ * J_.transpose() * S_.inverse();
  EXPECT_LT((mean_ + gain * r_).norm(), 1e-9);
  EXPECT_LT((covariance_ - P_ + gain * J_ * P_).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Ranks,
                         SequentialUpdateTest,
                         testing::Values(std::pair(kFew, kFew),
                                         std::pair(kFew, Eigen::Index{3}),
                                         std::pair(kFew, Eigen::Index{0}),
                                         std::pair(kMany, kMany)));

}  // namespace
}  // namespace sac
