#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"

namespace sac {

/// What moves the rotor beside its coils, as a motion has told it: each only where all of it is
/// told.
struct ToldDynamics {
  std::optional<Eigen::Matrix3d> inertia;                      ///< as in the Actuator
  std::optional<RotorFriction> friction;                       ///< the same
  std::optional<Eigen::Vector3d> unbalance;                    ///< the same
  Eigen::Vector3d unbalance_stddev = Eigen::Vector3d::Zero();  ///< where that is told [N·m]
};

/// Of the last motion of these cycles, also where their model does not know it; nothing without one
/// that succeeded.
ToldDynamics toldDynamics(const std::vector<CycleReport>& reports);

/// "", or a sentence where the moments of inertia that a motion has told are far from those of the
/// description, or where it has none from those that a motion begins with: torques by the
/// description are then as far from the real ones, or the rotor is another one.
std::string strangeInertiaInWords(const CycleReport& motion, const Actuator& described);

/// "", or a sentence: of strength and inertia one is found, the other is that of the drawing.
std::string exactInertiaInWords(const ParameterSpace& space);

}  // namespace sac
