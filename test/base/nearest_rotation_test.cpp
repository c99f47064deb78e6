#include "spherical_actuator_calibration/base/nearest_rotation.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

double angleBetween(const Eigen::Matrix3d& one, const Eigen::Matrix3d& other) {
  return rotationLog(one * other.transpose()).norm();
}

TEST(NearestRotation, OfARotationTimesAStretchIsTheRotation) {
  const Eigen::Matrix3d R = rotationExp({0.4, -1.0, 2.0});
  const Eigen::Matrix3d V = rotationExp({-0.3, 0.2, 0.5});
  const Eigen::Matrix3d stretch = V * Eigen::Vector3d(3.0, 0.5, 1.0).asDiagonal() * V.transpose();
  EXPECT_LT(angleBetween(nearestRotation(R * stretch), R), 1e-12);
}

TEST(NearestRotation, IsNoReflection) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1.0, 1.0, -0.1).asDiagonal();
  EXPECT_LT(angleBetween(nearestRotation(mirror), Eigen::Matrix3d::Identity()), 1e-12);
}

TEST(NearestRotation, NoOtherIsNearer) {
  scenarios::Generator generator(7);
  const Eigen::Matrix3d matrix =
      rotationExp({1.0, 0.2, -0.7}) + 0.3 * rotationExp({-2.0, 0.4, 0.1});
  const Eigen::Matrix3d R = nearestRotation(matrix);
  for (int n = 0; n < 100; ++n) {
    const Eigen::Matrix3d other = rotationExp(scenarios::uniformNoise(0.1, generator)) * R;
    EXPECT_LT((R - matrix).norm(), (other - matrix).norm());
  }
}

TEST(NearestRotation, OfPairsAreTheFramesOnEitherSide) {
  scenarios::Generator generator(8);
  const Eigen::Matrix3d X = rotationExp({2.0, -0.5, 1.0});
  const Eigen::Matrix3d Z = rotationExp({0.3, 2.5, -0.4});
  RotationPairSum sum;
  for (int n = 0; n < 8; ++n) {
    const Eigen::Matrix3d B = rotationExp(scenarios::uniformNoise(1.0, generator));
    sum.add(X.transpose() * B * Z, B);
  }
  const RotationPair found = sum.nearest();
  EXPECT_LT(angleBetween(found.X, X), 1e-10);
  EXPECT_LT(angleBetween(found.Z, Z), 1e-10);
}

}  // namespace
}  // namespace sac
