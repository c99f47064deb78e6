#include "spherical_actuator_calibration/actuator/rotor_mass.hpp"

#include <cmath>

#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

/// Inertia [kg·m²] of a body of revolution with the given moments along and across its unit axis.
Eigen::Matrix3d inertiaOfRevolution(const Eigen::Vector3d& axis, double along, double across) {
  return across * Eigen::Matrix3d::Identity() + (along - across) * axis * axis.transpose();
}

/// What a point mass adds about the origin.
Eigen::Matrix3d pointInertia(double mass, const Eigen::Vector3d& at) {
  return mass * (at.squaredNorm() * Eigen::Matrix3d::Identity() - at * at.transpose());
}

MassProperties hoopMass(const ActuatorDimensions& d) {
  const double inner = d.rotor_radius - d.hoop_thickness;
  const double squares = d.rotor_radius * d.rotor_radius + inner * inner;
  MassProperties hoop;
  hoop.mass =
      d.hoop_density * kPi * (d.rotor_radius * d.rotor_radius - inner * inner) * d.hoop_height;
  hoop.inertia =
      inertiaOfRevolution(Eigen::Vector3d::UnitZ(),
                          0.5 * hoop.mass * squares,
                          hoop.mass * (3.0 * squares + d.hoop_height * d.hoop_height) / 12.0);
  return hoop;
}

}  // namespace

MassProperties rotorMass(const Actuator& actuator, const ActuatorDimensions& d) {
  MassProperties rotor = hoopMass(d);
  const double square = d.pole_radius * d.pole_radius;
  const double mass = d.magnet_density * kPi * square * d.pole_height;
  const double along = 0.5 * mass * square;
  const double across = mass * (3.0 * square + d.pole_height * d.pole_height) / 12.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const PoleAxis& pole : actuator.poles) {
    const Eigen::Vector3d axis = axisFromAngles(pole.polar, pole.azimuth);
    const Eigen::Vector3d centre = d.poleDistance() * axis;
    rotor.mass += mass;
    moment += mass * centre;
    rotor.inertia += inertiaOfRevolution(axis, along, across) + pointInertia(mass, centre);
  }
  rotor.centre = moment / rotor.mass;
  rotor.inertia -= pointInertia(rotor.mass, rotor.centre);
  return rotor;
}

Eigen::Matrix3d rotorInertia(const Actuator& actuator, const ActuatorDimensions& dimensions) {
  const MassProperties rotor = rotorMass(actuator, dimensions);
  return rotor.inertia + pointInertia(rotor.mass, rotor.centre);
}

}  // namespace sac
