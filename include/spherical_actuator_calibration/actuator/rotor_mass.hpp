#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"

namespace sac {

/// Mass, centre of mass and inertia of a body, in the rotor frame.
struct MassProperties {
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< from the origin of the frame [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about `centre` [kg·m²]
};

/// The rotor of iron hoop and magnets, of homogeneous materials; what carries them weighs nothing.
MassProperties rotorMass(const Actuator& actuator, const ActuatorDimensions& dimensions);

/// Inertia of the same rotor about its centre of rotation, rotor frame [kg·m²].
Eigen::Matrix3d rotorInertia(const Actuator& actuator, const ActuatorDimensions& dimensions);

}  // namespace sac
