#include "spherical_actuator_calibration/control/current_allocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Torque per ampere of the paper's actuator at joint angles.
Eigen::Matrix3Xd torqueMatrix(const Eigen::Vector3d& q) {
  const Actuator actuator = scenarios::paperNominal();
  return torquePerAmpere(TorqueCurve(*actuator.torque_curve),
                         torqueGeometry(actuator),
                         rotorOrientation(jointGeometry(actuator.joints), q));
}

Eigen::VectorXd minimumNorm(const Eigen::Matrix3Xd& Q, const Eigen::Vector3d& torque) {
  return Eigen::MatrixXd(Q).completeOrthogonalDecomposition().solve(torque);
}

/// The largest share of a torque that currents within a limit can make, by duality: the smallest
/// limit · Σ |q_j · λ| / (T · λ) over directions λ. A random search comes close from above.
double largestShare(const Eigen::Matrix3Xd& Q, const Eigen::Vector3d& torque, double limit) {
  std::mt19937_64 generator(4);
  std::normal_distribution<double> normal;
  double smallest = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < 20000; ++trial) {
    const Eigen::Vector3d lambda(normal(generator), normal(generator), normal(generator));
    const double made = torque.dot(lambda);
    if (made > 0.0) {
      smallest = std::min(smallest, limit * (Q.transpose() * lambda).cwiseAbs().sum() / made);
    }
  }
  return smallest;
}

TEST(CurrentAllocation, IsTheMinimumNormSolutionWithinTheLimits) {
  scenarios::Generator generator(1);
  for (const Eigen::Vector3d& q : scenarios::randomPoses(30, 0.4, generator)) {
    const Eigen::Matrix3Xd Q = torqueMatrix(q);
    const Eigen::Vector3d torque(0.05, -0.03, 0.04);
    const AllocatedCurrents result = allocateCurrents(Q, torque, {10.0, 1e-3});
    EXPECT_EQ(result.outcome, Allocation::kReached);
    EXPECT_LT((result.currents - minimumNorm(Q, torque)).norm(), 1e-10);
    EXPECT_NEAR(result.smallest_singular_value,
                Eigen::JacobiSVD<Eigen::MatrixXd>(Q).singularValues()[2],
                1e-9);
  }
}

TEST(CurrentAllocation, KeepsTheTorqueWhenTheLimitsBind) {
  scenarios::Generator generator(2);
  int bound = 0;
  for (const Eigen::Vector3d& q : scenarios::randomPoses(100, 0.4, generator)) {
    const Eigen::Matrix3Xd Q = torqueMatrix(q);
    const Eigen::Vector3d torque = 0.4 * Eigen::Vector3d(0.3, -0.5, 0.8);
    const double limit = 0.9 * minimumNorm(Q, torque).cwiseAbs().maxCoeff();
    const AllocatedCurrents result = allocateCurrents(Q, torque, {limit, 1e-3});
    EXPECT_LE(result.currents.cwiseAbs().maxCoeff(), limit * (1.0 + 1e-12));
    EXPECT_LT((Q * result.currents - result.share * torque).norm(), 1e-9);
    const double possible = largestShare(Q, torque, limit);
    EXPECT_LE(result.share, std::min(1.0, possible) + 1e-9);
    EXPECT_GE(result.share, std::min(1.0, possible) - 0.02);
    bound += result.outcome == Allocation::kReached ? 1 : 0;
  }
  EXPECT_GT(bound, 30);
}

/// No small change of the currents that keeps torque and limits has less power.
TEST(CurrentAllocation, SpendsTheLeastPowerAtTheLimits) {
  const Eigen::Matrix3Xd Q = torqueMatrix({0.2, -0.1, 0.4});
  const Eigen::Vector3d torque(0.12, -0.2, 0.25);
  const double limit = 0.85 * minimumNorm(Q, torque).cwiseAbs().maxCoeff();
  const AllocatedCurrents result = allocateCurrents(Q, torque, {limit, 1e-3});
  ASSERT_EQ(result.outcome, Allocation::kReached);
  const Eigen::MatrixXd kernel = Eigen::FullPivLU<Eigen::MatrixXd>(Eigen::MatrixXd(Q)).kernel();
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::VectorXd direction =
        kernel * Eigen::VectorXd::NullaryExpr(kernel.cols(), [&] { return normal(generator); });
    const Eigen::VectorXd changed = result.currents + 1e-4 * direction.normalized();
    if (changed.cwiseAbs().maxCoeff() <= limit) {
      EXPECT_GE(changed.squaredNorm(), result.currents.squaredNorm() - 1e-12);
    }
  }
}

TEST(CurrentAllocation, MakesTheLargestShareOfATorqueBeyondTheLimits) {
  const Eigen::Matrix3Xd Q = torqueMatrix({0.1, 0.1, 0.2});
  const Eigen::Vector3d torque(5.0, 0.0, 0.0);
  const AllocatedCurrents result = allocateCurrents(Q, torque, {1.0, 1e-3});
  EXPECT_EQ(result.outcome, Allocation::kLimited);
  EXPECT_GT(result.share, 0.01);
  EXPECT_LT(result.share, 0.9);
  EXPECT_LE(result.currents.cwiseAbs().maxCoeff(), 1.0 + 1e-12);
  EXPECT_LT((Q * result.currents - result.share * torque).norm(), 1e-8);
  const AllocatedCurrents more = allocateCurrents(Q, 1.01 * result.share * torque, {1.0, 1e-3});
  EXPECT_EQ(more.outcome, Allocation::kLimited);
}

TEST(CurrentAllocation, GivesNoCurrentWhereATorqueIsOutOfReach) {
  Eigen::Matrix3Xd Q = Eigen::Matrix3Xd::Zero(3, 4);
  Q(0, 0) = 0.2;
  Q(1, 1) = 0.2;
  const AllocatedCurrents result = allocateCurrents(Q, {0.01, 0.01, 0.01}, {});
  EXPECT_EQ(result.outcome, Allocation::kSingular);
  EXPECT_TRUE(result.currents.isZero(0.0));
  EXPECT_EQ(result.share, 0.0);
}

TEST(CurrentAllocation, RefusesWhatIsNotFinite) {
  const Eigen::Matrix3Xd Q = torqueMatrix(Eigen::Vector3d::Zero());
  EXPECT_THROW(allocateCurrents(Q, {std::nan(""), 0.0, 0.0}, {}), DataError);
  EXPECT_THROW(allocateCurrents(Q, Eigen::Vector3d::Zero(), {0.0, 0.05}), ConfigError);
  EXPECT_TRUE(allocateCurrents(Q, Eigen::Vector3d::Zero(), {}).currents.isZero(0.0));
}

}  // namespace
}  // namespace sac
