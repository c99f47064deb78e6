#include "spherical_actuator_calibration/base/rotations.hpp"

#include <random>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Rotation vectors of every size that matters: zero, below and above the series limit, near π.
std::vector<Eigen::Vector3d> rotationVectors() {
  scenarios::Generator generator(7);
  std::vector<Eigen::Vector3d> vectors{Eigen::Vector3d::Zero()};
  for (const double angle : {1e-14, 1e-9, 1e-5, 9.9e-3, 1.01e-2, 0.3, 1.5, 3.0, kPi - 1e-7}) {
    vectors.push_back(angle * scenarios::uniformNoise(1.0, generator).normalized());
  }
  return vectors;
}

TEST(Rotations, ExponentialAgreesWithAxisAngle) {
  for (const Eigen::Vector3d& v : rotationVectors()) {
    const Eigen::Matrix3d expected =
        v.norm() > 0.0 ? Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix()
                       : Eigen::Matrix3d::Identity();
    EXPECT_LT((rotationExp(v) - expected).cwiseAbs().maxCoeff(), 1e-15) << v.transpose();
  }
}

TEST(Rotations, LogarithmInvertsExponential) {
  for (const Eigen::Vector3d& v : rotationVectors()) {
    EXPECT_LT((rotationLog(rotationExp(v)) - v).norm(), 1e-15 + 1e-15 * v.norm() * 4.0)
        << v.transpose();
  }
}

TEST(Rotations, LogarithmAtHalfTurnIsOneOfTheTwo) {
  const Eigen::Vector3d v = kPi * Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0;
  const Eigen::Vector3d found = rotationLog(rotationExp(v));
  EXPECT_LT(std::min((found - v).norm(), (found + v).norm()), 1e-7);
}

TEST(Rotations, LeftJacobianIsTheDerivativeOfTheExponential) {
  for (const Eigen::Vector3d& v : rotationVectors()) {
    const auto change = [&](const Eigen::VectorXd& delta) -> Eigen::VectorXd {
      return rotationLog(rotationExp(v + Eigen::Vector3d(delta)) * rotationExp(v).transpose());
    };
    const Eigen::MatrixXd numeric = numericJacobian(change, Eigen::Vector3d::Zero());
    EXPECT_LT((leftJacobian(v) - numeric).cwiseAbs().maxCoeff(), 1e-10) << v.transpose();
  }
}

TEST(Rotations, LeftJacobianInverseInverts) {
  for (const Eigen::Vector3d& v : rotationVectors()) {
    EXPECT_LT((leftJacobian(v) * leftJacobianInverse(v) - Eigen::Matrix3d::Identity())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12)
        << v.transpose();
  }
}

}  // namespace
}  // namespace sac
