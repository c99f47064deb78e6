#include "spherical_actuator_calibration/measurement/validation_poses.hpp"

#include <set>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

PosesToMeasure drawn(std::size_t poses, std::size_t coils, std::uint64_t seed) {
  return drawValidationPoses(scenarios::paperNominal(), {poses, coils, seed});
}

TEST(ValidationPoses, LieInsideTheWorkspaceAndAreTheSameForASeed) {
  const PosesToMeasure poses = drawn(50, 3, 7);
  EXPECT_EQ(poses, drawn(50, 3, 7));
  EXPECT_FALSE(poses == drawn(50, 3, 8));
  ASSERT_EQ(poses.size(), 50U);
  const double tilt = 0.8 * scenarios::paperNominal().workspace.tilt_limit;
  for (const PoseToMeasure& pose : poses) {
    EXPECT_TRUE(pose.validation);
    EXPECT_LE(pose.joint_position.head<2>().cwiseAbs().maxCoeff(), tilt);
    std::set<std::size_t> coils;
    for (const CoilPattern& pattern : pose.patterns) {
      ASSERT_EQ(pattern.size(), 1U);
      coils.insert(pattern[0].coil);
    }
    EXPECT_EQ(coils.size(), 3U);
  }
}

TEST(ValidationPoses, AreSpreadAlsoWhereMoreCoilsAreWantedThanSeeAPole) {
  const double tilt = 0.8 * scenarios::paperNominal().workspace.tilt_limit;
  double sum = 0.0;
  for (const PoseToMeasure& pose : drawn(200, 24, 3)) {
    sum += pose.joint_position.head<2>().cwiseAbs().mean();
  }
  EXPECT_GT(sum / 200.0, 0.35 * tilt);
}

TEST(ValidationPoses, ExciteNoCoilWhereNoPoleIsNear) {
  const Actuator nominal = scenarios::paperNominal();
  const TorqueCurve curve(*nominal.torque_curve);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    for (const PoseToMeasure& pose : drawn(2, 2, seed)) {
      const Eigen::Matrix3Xd torques =
          torquePerAmpere(curve,
                          torqueGeometry(nominal),
                          rotorOrientation(jointGeometry(nominal), pose.joint_position));
      for (const CoilPattern& pattern : pose.patterns) {
        // A tenth of the largest.
        EXPECT_GT(torques.col(static_cast<Eigen::Index>(pattern[0].coil)).norm(), 0.03) << seed;
      }
    }
  }
}

TEST(ValidationPoses, ExciteAllCoilsBeforeOneTwice) {
  std::set<std::size_t> coils;
  for (const PoseToMeasure& pose : drawn(16, 2, 5)) {
    for (const CoilPattern& pattern : pose.patterns) {
      coils.insert(pattern[0].coil);
    }
  }
  EXPECT_GE(coils.size(), 22U);  // of 24: not every coil sees a pole everywhere
}

TEST(ValidationPoses, HaveNoMoreCoilsThanThereAre) {
  for (const PoseToMeasure& pose : drawn(2, 100, 1)) {
    EXPECT_GT(pose.patterns.size(), 6U);
    EXPECT_LE(pose.patterns.size(), 24U);
  }
}

TEST(ValidationPoses, OfAJointAloneHaveNoCoils) {
  Actuator joint = scenarios::paperNominal();
  joint.poles.clear();
  joint.coils.clear();
  joint.torque_curve.reset();
  for (const PoseToMeasure& pose : drawValidationPoses(joint, {})) {
    EXPECT_TRUE(pose.patterns.empty());
  }
}

TEST(ValidationPoses, AreNoMoreThanASessionTakes) {
  EXPECT_THROW(drawn(1001, 2, 1), ConfigError);
  EXPECT_THROW(drawn(2, 1001, 1), ConfigError);
}

}  // namespace
}  // namespace sac
