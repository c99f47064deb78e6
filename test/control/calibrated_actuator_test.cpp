#include "spherical_actuator_calibration/control/calibrated_actuator.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// The paper's machine as made, poles and coils known to a milliradian.
CalibratedDescription calibrated() {
  CalibratedDescription description{scenarios::paperTruth(), {}, std::nullopt};
  description.stddevs.poles.assign(description.actuator.poles.size(), {1e-3, 1e-3});
  description.stddevs.coils.assign(description.actuator.coils.size(), {1e-3, 1e-3});
  return description;
}

const Eigen::Vector3d& somewhere() {
  static const Eigen::Vector3d reading(0.1, -0.2, 0.7);
  return reading;
}

TEST(CalibratedActuator, CurrentsMakeTheTorqueThatWasAskedFor) {
  const CalibratedActuator actuator(calibrated());
  const Eigen::Vector3d wanted(0.05, -0.03, 0.04);
  const CalibratedActuator::Currents found = actuator.currents(wanted, somewhere());
  EXPECT_EQ(found.outcome, Allocation::kReached);
  EXPECT_LT((found.torque - wanted).norm(), 1e-12);
  const Predictor::Torque made = actuator.torque(somewhere(), found.currents);
  EXPECT_LT((made.torque - wanted).norm(), 1e-12);
  EXPECT_EQ(found.torque_stddev, made.stddev);
  EXPECT_GT(made.stddev, 0.0);
  // Coils out of reach of all poles have neither.
  EXPECT_GE(found.stddev.minCoeff(), 0.0);
  EXPECT_GT(found.stddev.maxCoeff(), 0.0);
  // Of currents below half an ampere, milliradians make no more than some hundredths.
  EXPECT_LT(found.stddev.maxCoeff(), 0.05);
}

// Against machines that differ from the description by what it states.
TEST(CalibratedActuator, CurrentsAreAsUncertainAsTheTorqueThatTheyMake) {
  constexpr int kMachines = 2000;
  const CalibratedDescription description = calibrated();
  const Eigen::Vector3d wanted(0.05, -0.03, 0.04);
  const auto found = CalibratedActuator(description).currents(wanted, somewhere());
  const TorqueCurve curve(*description.actuator.torque_curve);
  const auto torque_matrix = [&](const Actuator& actuator) -> Eigen::Matrix3Xd {
    const Eigen::Matrix3d R = rotorOrientation(jointGeometry(actuator), somewhere());
    return torquePerAmpere(curve, torqueGeometry(actuator), R);
  };
  const Eigen::MatrixXd correction = Eigen::MatrixXd(torque_matrix(description.actuator))
                                         .completeOrthogonalDecomposition()
                                         .pseudoInverse();
  std::mt19937_64 generator(1);
  std::normal_distribution<double> error(0.0, 1e-3);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(found.currents.size());
  for (int n = 0; n < kMachines; ++n) {
    Actuator machine = description.actuator;
    for (PoleAxis& pole : machine.poles) {
      pole.polar += error(generator);
      pole.azimuth += error(generator);
    }
    for (CoilAxis& coil : machine.coils) {
      coil.polar += error(generator);
      coil.azimuth += error(generator);
    }
    const Eigen::Vector3d missing = wanted - torque_matrix(machine) * found.currents;
    squares += (correction * missing).cwiseAbs2();
  }
  for (Eigen::Index j = 0; j < squares.size(); ++j) {
    EXPECT_NEAR(found.stddev[j], std::sqrt(squares[j] / kMachines), 0.06 * found.stddev[j] + 1e-9)
        << "coil " << j + 1;
  }
}

TEST(CalibratedActuator, GainsCountOnce) {
  CalibratedDescription weak = calibrated();
  for (CoilAxis& coil : weak.actuator.coils) {
    coil.gain = 0.5;
  }
  const Eigen::Vector3d wanted(0.05, -0.03, 0.04);
  const auto plain = CalibratedActuator(calibrated()).currents(wanted, somewhere());
  const auto more = CalibratedActuator(weak).currents(wanted, somewhere());
  EXPECT_LT((more.currents - 2.0 * plain.currents).norm(), 1e-12);
  EXPECT_LT((more.torque - wanted).norm(), 1e-12);
}

TEST(CalibratedActuator, SaysWhatItCannotTell) {
  const CalibratedActuator actuator(calibrated());
  EXPECT_THROW(actuator.torque(somewhere(), Eigen::VectorXd::Zero(3)), DataError);
  EXPECT_THROW(actuator.orientation({0.0, std::nan(""), 0.0}), DataError);
  CalibratedDescription joints_alone = calibrated();
  joints_alone.actuator.torque_curve.reset();
  const CalibratedActuator without(joints_alone);
  EXPECT_FALSE(without.hasTorqueModel());
  EXPECT_THROW(without.currents(Eigen::Vector3d::Zero(), somewhere()), DataError);
  EXPECT_NO_THROW(without.orientation(somewhere()));
}

}  // namespace
}  // namespace sac
