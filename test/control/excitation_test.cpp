#include "spherical_actuator_calibration/control/excitation.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

Eigen::Matrix3Xd exampleTorques() {
  const Actuator actuator = scenarios::paperNominal();
  return torquePerAmpere(
      TorqueCurve(*actuator.torque_curve), torqueGeometry(actuator), rotationExp({0.2, -0.1, 0.7}));
}

Eigen::VectorXd alternating(double current) {
  Eigen::VectorXd currents(24);
  for (Eigen::Index j = 0; j < currents.size(); ++j) {
    currents[j] = (j % 3 == 0 ? 1.0 : -0.5) * current;
  }
  return currents;
}

TEST(Excitation, WhatIsLeftMakesNoTorqueAndIsTheNearest) {
  const Eigen::Matrix3Xd Q = exampleTorques();
  const Eigen::VectorXd wanted = alternating(1.0);
  const Eigen::VectorXd left = withoutTorque(Q, wanted);
  EXPECT_LT((Q * left).norm(), 1e-12);
  EXPECT_GT((Q * wanted).norm(), 1e-3);
  // What was taken out is a torque's currents alone.
  EXPECT_LT((withoutTorque(Q, wanted - left)).norm(), 1e-12);
  EXPECT_GT(left.norm(), 0.5 * wanted.norm());
}

TEST(Excitation, ThereIsNoneWhereTheCoilsMakeNoTorqueInSomeDirection) {
  Eigen::Matrix3Xd Q = exampleTorques();
  Q.row(2).setZero();
  EXPECT_TRUE(withoutTorque(Q, alternating(1.0)).isZero(0.0));
}

TEST(Excitation, TheShareIsTheLargestWithinEachBound) {
  const Eigen::VectorXd control = alternating(0.1);
  const Eigen::VectorXd excitation = alternating(1.0);
  EXPECT_EQ(excitationShare(control, excitation, {2.0, 100.0, 100.0}), 1.0);
  // 0.1 + share = 0.6 in the strongest coil.
  EXPECT_NEAR(excitationShare(control, excitation, {0.6, 100.0, 100.0}), 0.5, 1e-5);
  const double sum = excitation.cwiseAbs().sum();
  EXPECT_NEAR(excitationShare(control, excitation, {2.0, 0.6 * sum, 100.0}), 0.5, 1e-5);
  const double squares = excitation.squaredNorm();
  EXPECT_NEAR(excitationShare(control, excitation, {2.0, 100.0, 0.36 * squares}), 0.5, 1e-5);
  EXPECT_EQ(excitationShare(alternating(0.7), excitation, {0.6, 100.0, 100.0}), 0.0);
}

TEST(Excitation, SumsAreKeptByAllCurrentsAlike) {
  const Eigen::VectorXd currents = alternating(1.0);
  const double sum = currents.cwiseAbs().sum();
  EXPECT_EQ(shareWithinSums(currents, {0.1, sum, 100.0}), 1.0);
  EXPECT_NEAR(shareWithinSums(currents, {0.1, 0.5 * sum, 100.0}), 0.5, 1e-12);
  const double square = 0.25 * currents.squaredNorm();
  EXPECT_NEAR(shareWithinSums(currents, {0.1, sum, square}), 0.5, 1e-12);
}

}  // namespace
}  // namespace sac
