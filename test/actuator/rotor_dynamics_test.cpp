#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

constexpr double kTimeStep = 1e-3;  // [s]

Eigen::Vector3d noTorque(const Eigen::Matrix3d& /*R_stator_rotor*/) {
  return Eigen::Vector3d::Zero();
}

RigidRotor heavyRotor() {
  RigidRotor rotor;
  rotor.inertia = Eigen::Vector3d(0.7e-3, 0.9e-3, 1.3e-3).asDiagonal();
  rotor.unbalance = Eigen::Vector3d(2e-3, -1e-3, 8e-3);
  return rotor;
}

RotorState tumbling() {
  return {rotationExp({0.4, -0.3, 0.8}), Eigen::Vector3d(3.0, -2.0, 5.0)};
}

RotorState after(const RigidRotor& rotor, RotorState state, double time, double step) {
  const auto steps = static_cast<int>(std::round(time / step));
  for (int n = 0; n < steps; ++n) {
    state = advance(rotor, state, noTorque, step);
  }
  return state;
}

/// Kinetic and potential energy [J]; the latter is 0 with the centre of gravity level with the
/// centre.
double energyOf(const RigidRotor& rotor, const RotorState& state) {
  const Eigen::Vector3d& w = state.angular_velocity;
  return 0.5 * w.dot(rotor.inertia * w) +
         rotor.unbalance.dot(state.R_stator_rotor.row(2).transpose());
}

double angleBetween(const Eigen::Matrix3d& one, const Eigen::Matrix3d& other) {
  return rotationLog(one * other.transpose()).norm();
}

TEST(RotorDynamics, ConservesEnergyForTenSeconds) {
  const RigidRotor rotor = heavyRotor();
  RotorState state = tumbling();
  const double energy = energyOf(rotor, state);
  for (int second = 0; second < 10; ++second) {
    state = after(rotor, state, 1.0, kTimeStep);
    EXPECT_NEAR(energyOf(rotor, state) / energy, 1.0, 1e-6) << second;
    EXPECT_LT(
        (state.R_stator_rotor * state.R_stator_rotor.transpose() - Eigen::Matrix3d::Identity())
            .norm(),
        1e-12);
  }
}

TEST(RotorDynamics, ConservesAngularMomentumWithoutGravity) {
  RigidRotor rotor = heavyRotor();
  rotor.unbalance.setZero();
  const auto momentum = [&rotor](const RotorState& state) {
    return (state.R_stator_rotor * rotor.inertia * state.angular_velocity).eval();
  };
  const RotorState end = after(rotor, tumbling(), 10.0, kTimeStep);
  EXPECT_LT((momentum(end) - momentum(tumbling())).norm() / momentum(tumbling()).norm(), 1e-6);
}

TEST(RotorDynamics, HalfTheStepMakesNoDifference) {
  const RotorState coarse = after(heavyRotor(), tumbling(), 10.0, kTimeStep);
  const RotorState fine = after(heavyRotor(), tumbling(), 10.0, 0.5 * kTimeStep);
  EXPECT_LT(angleBetween(coarse.R_stator_rotor, fine.R_stator_rotor), 1e-5);
  const RotorState rough = after(heavyRotor(), tumbling(), 10.0, 20.0 * kTimeStep);
  EXPECT_GT(angleBetween(rough.R_stator_rotor, fine.R_stator_rotor), 1e-5);
}

TEST(RotorDynamics, SpinsSteadilyAboutAPrincipalAxis) {
  const RotorState end =
      after({}, {Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, 0.0, 2.0)}, 1.0, kTimeStep);
  EXPECT_LT(angleBetween(end.R_stator_rotor, rotationExp({0.0, 0.0, 2.0})), 1e-9);
}

TEST(RotorDynamics, SwingsAsAPendulum) {
  RigidRotor rotor;
  rotor.unbalance = Eigen::Vector3d(0.0, 0.0, -8e-3);
  const double period = 2.0 * std::acos(-1.0) * std::sqrt(rotor.inertia(0, 0) / 8e-3);
  const Eigen::Matrix3d tilted = rotationExp({1e-3, 0.0, 0.0});
  const RotorState half =
      after(rotor, {tilted, Eigen::Vector3d::Zero()}, 0.5 * period, period / 4e3);
  EXPECT_LT(angleBetween(half.R_stator_rotor, tilted.transpose()), 1e-8);
}

TEST(RotorDynamics, AConstantTorqueAccelerates) {
  const RigidRotor rotor;
  RotorState state;
  for (int n = 0; n < 100; ++n) {
    state = advance(
        rotor,
        state,
        [](const Eigen::Matrix3d&) { return Eigen::Vector3d(0.0, 0.0, 2.6e-3); },
        1e-2);
  }
  EXPECT_NEAR(state.angular_velocity.z(), 2.0, 1e-12);
  EXPECT_LT(angleBetween(state.R_stator_rotor, rotationExp({0.0, 0.0, 1.0})), 1e-9);
}

TEST(RotorDynamics, RefusesBodiesThatCannotBe) {
  RigidRotor rotor;
  rotor.inertia(0, 1) = 1e-4;
  EXPECT_THROW(validate(rotor), ConfigError);
  rotor.inertia = Eigen::Vector3d(1e-3, 1e-3, 3e-3).asDiagonal();
  EXPECT_THROW(validate(rotor), ConfigError);
  rotor.inertia = Eigen::Vector3d(1e-3, -1e-3, 1e-3).asDiagonal();
  EXPECT_THROW(validate(rotor), ConfigError);
  rotor = {};
  rotor.unbalance.x() = std::nan("");
  EXPECT_THROW(validate(rotor), ConfigError);
  EXPECT_NO_THROW(validate(RigidRotor{}));
}

}  // namespace
}  // namespace sac
