#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/workspace_uncertainty.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

const CalibrationModel& paperModel() {
  static const CalibrationModel model{ParameterSpace(scenarios::paperNominal())};
  return model;
}

/// Everything known but one coordinate, by `stddev`.
ParameterBelief uncertainIn(Eigen::Index coordinate, double stddev) {
  const Eigen::Index size = paperModel().space().size();
  ParameterBelief belief;
  belief.x = Eigen::VectorXd::Zero(size);
  belief.covariance = Eigen::MatrixXd::Zero(size, size);
  belief.covariance(coordinate, coordinate) = stddev * stddev;
  return belief;
}

TEST(WorkspaceMap, AnOffsetIsTheSameErrorEverywhere) {
  const WorkspaceMap map = workspaceMap(paperModel(), uncertainIn(0, 2e-3), 5, 3);
  EXPECT_NEAR(map.tilt[0], -0.6, 1e-15);
  EXPECT_NEAR(map.tilt[4], 0.6, 1e-15);
  ASSERT_EQ(map.orientation.rows(), 5);
  ASSERT_EQ(map.orientation.cols(), 5);
  EXPECT_LT((map.orientation.array() - 2e-3).abs().maxCoeff(), 1e-12);
}

/// Turning the axis of joint 1 by δ leaves an error of 2 sin(q/2) δ at angle q of that joint.
TEST(WorkspaceMap, AnAxisErrorGrowsWithTheAngleOfItsJoint) {
  const WorkspaceMap map = workspaceMap(paperModel(), uncertainIn(1, 1e-3), 7, 2);
  for (Eigen::Index row = 0; row < 7; ++row) {
    const double expected = 2.0 * std::abs(std::sin(0.5 * map.tilt[row])) * 1e-3;
    for (Eigen::Index column = 0; column < 7; ++column) {
      EXPECT_NEAR(map.orientation(row, column), expected, 1e-9);
    }
  }
}

/// Upright, over the whole spin, all coils of a layer look alike.
TEST(WorkspaceMap, TorqueErrorIsTheRootMeanSquareOverTheCoils) {
  const ParameterSpace& space = paperModel().space();
  const WorkspaceMap one = workspaceMap(paperModel(), uncertainIn(space.coil(3), 1e-3), 3, 24);
  ParameterBelief both = uncertainIn(space.coil(3), 1e-3);
  both.covariance(space.coil(4), space.coil(4)) = 1e-6;
  const WorkspaceMap two = workspaceMap(paperModel(), both, 3, 24);
  EXPECT_EQ(one.orientation.maxCoeff(), 0.0);
  EXPECT_GT(one.torque(1, 1), 1e-5);
  EXPECT_NEAR(two.torque(1, 1), std::sqrt(2.0) * one.torque(1, 1), 1e-9);
}

TEST(WorkspaceMap, NoTorqueWithoutTorqueModel) {
  Actuator joint_only = scenarios::paperNominal();
  joint_only.poles.clear();
  joint_only.coils.clear();
  joint_only.torque_curve.reset();
  const CalibrationModel model{ParameterSpace(joint_only)};
  ParameterBelief belief;
  belief.x = Eigen::VectorXd::Zero(9);
  belief.covariance = Eigen::MatrixXd::Identity(9, 9) * 1e-6;
  EXPECT_EQ(workspaceMap(model, belief, 3, 2).torque.size(), 0);
}

}  // namespace
}  // namespace sac
