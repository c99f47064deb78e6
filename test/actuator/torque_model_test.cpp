#include "spherical_actuator_calibration/actuator/torque_model.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// The paper's torque as printed, (21–22): with arccos and a division by ‖r×s‖.
Eigen::Vector3d printedTorque(const Actuator& actuator,
                              const Eigen::Matrix3d& R_stator_rotor,
                              const Eigen::VectorXd& current) {
  const TorqueCurve curve(*actuator.torque_curve);
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
    const Eigen::Vector3d r = axisFromAngles(actuator.poles[i].polar, actuator.poles[i].azimuth);
    for (std::size_t j = 0; j < actuator.coils.size(); ++j) {
      const Eigen::Vector3d s = R_stator_rotor.transpose() *
                                axisFromAngles(actuator.coils[j].polar, actuator.coils[j].azimuth);
      const double psi = std::acos(r.dot(s));
      torque += actuator.poles[i].polarity * current[static_cast<Eigen::Index>(j)] *
                curve.value(psi) * r.cross(s).normalized();
    }
  }
  return torque;
}

TEST(TorqueModel, AgreesWithThePrintedEquations) {
  const Actuator actuator = scenarios::paperTruth();
  const TorqueCurve curve(*actuator.torque_curve);
  scenarios::Generator generator(11);
  for (int n = 0; n < 20; ++n) {
    const Eigen::Matrix3d R = rotationExp(scenarios::uniformNoise(2.0, generator));
    Eigen::VectorXd current(24);
    for (Eigen::Index j = 0; j < 24; ++j) {
      current[j] = scenarios::uniformNoise(2.0, generator)[0];
    }
    const Eigen::Vector3d torque = rotorTorque(curve, torqueGeometry(actuator), R, current);
    EXPECT_GT(torque.norm(), 1e-3);
    EXPECT_LT((torque - printedTorque(actuator, R, current)).norm(), 1e-13);
    EXPECT_LT((torquePerAmpere(curve, torqueGeometry(actuator), R) * current - torque).norm(),
              1e-14);
  }
}

TEST(TorqueModel, GainsScaleTheirPoleAndCoil) {
  Actuator actuator = scenarios::paperNominal();
  const TorqueCurve curve(*actuator.torque_curve);
  const Eigen::Matrix3d R = rotationExp({0.05, 0.1, 0.2});
  const Eigen::Matrix3Xd before = torquePerAmpere(curve, torqueGeometry(actuator), R);
  actuator.coils[0].gain = 1.25;
  for (PoleAxis& pole : actuator.poles) {
    pole.gain = 0.5;
  }
  const Eigen::Matrix3Xd after = torquePerAmpere(curve, torqueGeometry(actuator), R);
  EXPECT_LT((after.col(0) - 0.625 * before.col(0)).norm(), 1e-15);
  EXPECT_LT((after.col(1) - 0.5 * before.col(1)).norm(), 1e-15);
}

TEST(TorqueModel, PairDerivativesAreThoseOfThePairTorque) {
  const TorqueCurve curve(*scenarios::paperNominal().torque_curve);
  const Eigen::Vector3d r = axisFromAngles(0.1, 0.4);
  // At a blend the second derivative jumps: finite differences stay clear of it.
  for (const double degrees : {0.0, 0.02, 1.0, 5.0, 15.0, 25.0, 30.0, 33.0}) {
    const double psi = degrees * kOneDegree;
    const Eigen::Vector3d s =
        Eigen::AngleAxisd(psi, r.cross(Eigen::Vector3d(0.3, -0.5, 0.7)).normalized()) * r;
    const PairTorque pair = linearizePairTorque(curve, r, s);
    EXPECT_LT((pair.torque - pairTorque(curve, r, s)).norm(), 1e-16);
    // Rotating an axis keeps it unit: δr = ω × r = −r̂ ω.
    const auto turned = [&](const Eigen::VectorXd& w) -> Eigen::VectorXd {
      Eigen::VectorXd both(6);
      both << pairTorque(curve, rotationExp(w) * r, s), pairTorque(curve, r, rotationExp(w) * s);
      return both;
    };
    const Eigen::MatrixXd numeric = numericJacobian(turned, Eigen::Vector3d::Zero());
    const double tolerance = 2e-7;
    EXPECT_LT((-pair.d_pole * skew(r) - numeric.topRows<3>()).cwiseAbs().maxCoeff(), tolerance)
        << degrees;
    EXPECT_LT((-pair.d_coil * skew(s) - numeric.bottomRows<3>()).cwiseAbs().maxCoeff(), tolerance)
        << degrees;
  }
}

TEST(TorqueModel, AlignedPairExertsNoTorqueButAFiniteStiffness) {
  const TorqueCurve curve(*scenarios::paperNominal().torque_curve);
  const Eigen::Vector3d r = axisFromAngles(0.2, 1.0);
  const PairTorque pair = linearizePairTorque(curve, r, r);
  EXPECT_EQ(pair.torque, Eigen::Vector3d::Zero());
  EXPECT_TRUE(pair.d_pole.allFinite());
  EXPECT_GT(pair.d_pole.norm(), 1.0);
}

}  // namespace
}  // namespace sac
