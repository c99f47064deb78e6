#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "control/control_cycle.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"
#include "spherical_actuator_calibration/emulation/free_rotor.hpp"
#include "support/scenarios.hpp"

namespace sac {

inline constexpr double kStopTilt = 1.0;

/// A load whose holding needs some tenths of an ampere.
inline RigidRotor loadedRotor() {
  RigidRotor rotor;
  rotor.unbalance = Eigen::Vector3d(0.002, 0.0088, 0.003);
  return rotor;
}

/// The controller and the true rotor, cycle by cycle.
class ControlledRotor : public ::testing::Test {
 protected:
  ControlledRotor() : truth_(scenarios::paperTruth()), rotor_(truth_, loadedRotor(), kStopTilt) {
    options_.rotor = loadedRotor();
    rotor_.release(Eigen::Vector3d::Zero());
    restart();
  }

  void restart() {
    controller_.emplace(scenarios::paperNominal(), options_);
    controller_->receive({now_, rotor_.position()});
  }

  void start(const Actuator& parameters) {
    controller_->setParameters(parameters);
    controller_->enable(now_);
  }

  /// Runs for so long [s]; returns the largest current [A].
  double run(double seconds) {
    double largest = 0.0;
    for (int n = 0; n < std::lround(seconds * 1e3); ++n) {
      now_ += kCycle;
      controller_->receive({now_, rotor_.position()});
      const Eigen::VectorXd& currents = controller_->update(now_);
      largest = std::max(largest, currents.cwiseAbs().maxCoeff());
      rotor_.advance(1e-3, currents);
    }
    return largest;
  }

  /// What the coils really do [N·m].
  Eigen::Vector3d trueTorque(const Eigen::VectorXd& currents) const {
    return rotorTorque(TorqueCurve(*truth_.torque_curve),
                       torqueGeometry(truth_),
                       rotor_.state().R_stator_rotor,
                       currents);
  }

  double errorTo(const Eigen::Matrix3d& target) const {
    return rotationLog(target.transpose() * rotor_.state().R_stator_rotor).norm();
  }

  void expectStopped(const std::string& reason) {
    EXPECT_EQ(controller_->state(), ControlState::kStopped);
    EXPECT_NE(controller_->stopReason().find(reason), std::string::npos)
        << controller_->stopReason();
    EXPECT_TRUE(controller_->update(now_).isZero(0.0));
  }

  Actuator truth_;
  OrientationControllerOptions options_;
  FreeRotor rotor_;
  std::optional<OrientationController> controller_;
  Stamp now_ = 1000 * kCycle;
};

}  // namespace sac
