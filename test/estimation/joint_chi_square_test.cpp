#include "spherical_actuator_calibration/estimation/joint_chi_square.hpp"

#include <random>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "estimation/random_matrix.hpp"

namespace sac {
namespace {

constexpr Eigen::Index kCoordinates = 9;
constexpr Eigen::Index kJointResiduals = 12;

/// By the definition, with residuals that do not depend on all coordinates and a covariance of any
/// rank.
void expectByDefinition(Eigen::Index rank) {
  std::mt19937_64 generator(3);
  Eigen::MatrixXd J = randomMatrix(kJointResiduals, kCoordinates, generator);
  J.col(0).setZero();
  J.col(4).setZero();
  const Eigen::MatrixXd root = randomMatrix(kCoordinates, rank, generator);
  const Eigen::MatrixXd P = root * root.transpose();
  const Eigen::VectorXd r = randomMatrix(kJointResiduals, 1, generator);
  const Eigen::MatrixXd S =
      Eigen::MatrixXd::Identity(kJointResiduals, kJointResiduals) + J * P * J.transpose();
  EXPECT_NEAR(jointChiSquare(J.transpose() * J, J.transpose() * r, r.squaredNorm(), P),
              r.dot(S.llt().solve(r)),
              1e-9)
      << rank;
}

TEST(JointChiSquare, IsThatOfTheirCovariance) {
  for (const Eigen::Index rank : {kCoordinates, Eigen::Index{3}, Eigen::Index{0}}) {
    expectByDefinition(rank);
  }
}

TEST(JointChiSquare, OfResidualsThatDependOnNothingIsTheirSquare) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(kCoordinates, kCoordinates);
  EXPECT_EQ(jointChiSquare(none, Eigen::VectorXd::Zero(kCoordinates), 2.5, none), 2.5);
}

}  // namespace
}  // namespace sac
