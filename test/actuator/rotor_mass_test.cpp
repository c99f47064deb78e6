#include "spherical_actuator_calibration/actuator/rotor_mass.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Integral over a tube along `axis` by summation over small pieces.
MassProperties summed(double density,
                      double inner,
                      double outer,
                      double height,
                      const Eigen::Vector3d& axis,
                      const Eigen::Vector3d& centre) {
  const Eigen::Matrix3d R =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
  constexpr int kSteps = 40;
  MassProperties sum;
  for (int a = 0; a < kSteps; ++a) {
    const double radius = inner + (a + 0.5) / kSteps * (outer - inner);
    const double piece =
        density * radius * (outer - inner) / kSteps * 2.0 * kPi / kSteps * height / kSteps;
    for (int b = 0; b < kSteps; ++b) {
      const double angle = 2.0 * kPi * b / kSteps;
      for (int c = 0; c < kSteps; ++c) {
        const double z = ((c + 0.5) / kSteps - 0.5) * height;
        const Eigen::Vector3d at =
            centre + R * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), z);
        sum.mass += piece;
        sum.centre += piece * at;
        sum.inertia +=
            piece * (at.squaredNorm() * Eigen::Matrix3d::Identity() - at * at.transpose());
      }
    }
  }
  return sum;
}

/// The whole rotor by summation; inertia about the centre of mass.
MassProperties summedRotor(const Actuator& actuator, const ActuatorDimensions& d) {
  MassProperties rotor = summed(d.hoop_density,
                                d.rotor_radius - d.hoop_thickness,
                                d.rotor_radius,
                                d.hoop_height,
                                Eigen::Vector3d::UnitZ(),
                                Eigen::Vector3d::Zero());
  for (const PoleAxis& pole : actuator.poles) {
    const Eigen::Vector3d axis = axisFromAngles(pole.polar, pole.azimuth);
    const MassProperties magnet =
        summed(d.magnet_density, 0.0, d.pole_radius, d.pole_height, axis, d.poleDistance() * axis);
    rotor.mass += magnet.mass;
    rotor.centre += magnet.centre;
    rotor.inertia += magnet.inertia;
  }
  rotor.centre /= rotor.mass;
  rotor.inertia -= rotor.mass * (rotor.centre.squaredNorm() * Eigen::Matrix3d::Identity() -
                                 rotor.centre * rotor.centre.transpose());
  return rotor;
}

TEST(RotorMass, OfThePaperIsTheOneThatItsDynamicsAssume) {
  const MassProperties rotor = rotorMass(scenarios::paperNominal(), {});
  EXPECT_NEAR(rotor.inertia(0, 0), 0.7e-3, 0.05e-3);
  EXPECT_NEAR(rotor.inertia(1, 1), 0.7e-3, 0.05e-3);
  EXPECT_NEAR(rotor.inertia(2, 2), 1.3e-3, 0.05e-3);
  EXPECT_NEAR(rotor.mass, 0.556, 0.002);
  EXPECT_LT(rotor.centre.norm(), 1e-12);
}

TEST(RotorMass, AgreesWithASumOverSmallPieces) {
  Actuator actuator = scenarios::paperNominal();
  // Neither symmetric nor balanced.
  actuator.poles = {{0.3, 0.2, 1, 1.0}, {-0.1, 1.9, -1, 1.0}, {0.6, 3.5, 1, 1.0}};
  const MassProperties rotor = rotorMass(actuator, {});
  const MassProperties expected = summedRotor(actuator, {});
  EXPECT_NEAR(rotor.mass, expected.mass, 1e-9);
  EXPECT_LT((rotor.centre - expected.centre).norm(), 1e-9);
  EXPECT_GT(rotor.centre.norm(), 1e-3);
  EXPECT_LT((rotor.inertia - expected.inertia).norm(), 1e-3 * expected.inertia.norm());
}

TEST(RotorMass, InertiaAboutTheCentreIsThatOfThePapersDynamics) {
  const Eigen::Matrix3d inertia = rotorInertia(scenarios::paperNominal(), {});
  EXPECT_LT((inertia - RigidRotor().inertia).cwiseAbs().maxCoeff(), 5e-5);
  // One magnet less: the centre of gravity leaves the centre, and the inertia about it is less.
  Actuator lame = scenarios::paperNominal();
  lame.poles.pop_back();
  const MassProperties rotor = rotorMass(lame, {});
  EXPECT_GT(rotor.centre.norm(), 1e-3);
  EXPECT_GT(rotorInertia(lame, {})(2, 2), rotor.inertia(2, 2));
}

}  // namespace
}  // namespace sac
