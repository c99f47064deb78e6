#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
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

/// An actuator as it moves and pulls, by its description alone.
struct Machine {
  Machine(const Actuator& actuator, const Eigen::Vector3d& reading)
      : R_stator_rotor(rotorOrientation(jointGeometry(actuator), reading)),
        torque_per_ampere(torquePerAmpere(
            TorqueCurve(*actuator.torque_curve), torqueGeometry(actuator), R_stator_rotor)) {}

  Eigen::Matrix3d R_stator_rotor;
  Eigen::Matrix3Xd torque_per_ampere;
};

/// Trace of the covariance of orientation and of torque per ampere, by differences of descriptions
/// whose coordinates differ by the columns of a root of their covariance.
struct ExpectedSquares {
  double orientation = 0.0;
  Eigen::VectorXd torque;  ///< per coil
};

ExpectedSquares expectedSquares(const ParameterSpace& space,
                                const Eigen::VectorXd& x,
                                const Eigen::MatrixXd& root,
                                const Eigen::Vector3d& reading) {
  ExpectedSquares squares{0.0, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.coils()))};
  for (Eigen::Index k = 0; k < root.cols(); ++k) {
    const Machine after(space.actuatorAt(x + root.col(k)), reading);
    const Machine before(space.actuatorAt(x - root.col(k)), reading);
    const Eigen::Matrix3d apart = after.R_stator_rotor * before.R_stator_rotor.transpose();
    squares.orientation += std::pow(0.5 * Eigen::AngleAxisd(apart).angle(), 2);
    squares.torque += (0.5 * (after.torque_per_ampere - before.torque_per_ampere))
                          .colwise()
                          .squaredNorm()
                          .transpose();
  }
  return squares;
}

/// What was identified beside the axes belongs to the machine, and is as uncertain; what belongs to
/// the laboratory does not.
TEST(WorkspaceMap, CountsTheEffectsThatBelongToTheMachine) {
  constexpr double kSize = 0.02;
  constexpr double kStddev = 1e-7;
  constexpr int kSpins = 3;
  EffectSelection effects;
  for (const char* const effect : {"coil_gains",
                                   "pole_gains",
                                   "encoder_harmonics",
                                   "tilt_cross_axis",
                                   "torque_curve",
                                   "torque_bias",
                                   "marker_registration",
                                   "tracker_registration"}) {
    effects[effect] = true;
  }
  const CalibrationModel model{ParameterSpace(scenarios::paperNominal(), effects)};
  const ParameterSpace& space = model.space();
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  ParameterBelief belief;
  belief.x = kSize * Eigen::VectorXd::NullaryExpr(space.size(), [&] { return normal(generator); });
  Eigen::MatrixXd root = kStddev * Eigen::MatrixXd::NullaryExpr(space.size(), space.size(), [&] {
                           return normal(generator);
                         });
  belief.covariance = root * root.transpose();
  for (const PlacedEffect& placed : space.effects().effects()) {
    if (placed.belongs_to != LaboratoryEffect::BelongsTo::kActuator) {
      root.middleRows(space.effect() + placed.first, placed.size()).setZero();
    }
  }
  const WorkspaceMap map = workspaceMap(model, belief, 2, kSpins);
  ExpectedSquares sum{0.0, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.coils()))};
  for (int s = 0; s < kSpins; ++s) {
    const Eigen::Vector3d reading(map.tilt[1], map.tilt[0], kPi * (2.0 * s / kSpins - 1.0));
    const ExpectedSquares at = expectedSquares(space, belief.x, root, reading);
    sum.orientation += at.orientation / kSpins;
    sum.torque += at.torque / kSpins;
  }
  EXPECT_NEAR(map.orientation(1, 0) / std::sqrt(sum.orientation), 1.0, 1e-6);
  EXPECT_NEAR(map.torque(1, 0) / std::sqrt(sum.torque.mean()), 1.0, 1e-5);
}

}  // namespace
}  // namespace sac
