#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "wiring_case.hpp"

namespace sac {

/// What the torque of one sample should be at the nominal description, and how well that is known
/// within the tolerance.
struct PredictedTorque {
  std::size_t sample = 0;          ///< its place in the case
  Eigen::Vector3d measured;        ///< [N·m]
  Eigen::Matrix3d R_stator_rotor;  ///< as far as known
  Eigen::VectorXd current;         ///< [A]
  Eigen::Matrix3Xd per_ampere;     ///< of each coil [N·m/A]
  Eigen::VectorXd coil_variance;   ///< of a component of per_ampere by the tolerance
  Eigen::Matrix3Xd of_pole;        ///< torque of each pole at the currents [N·m]
  Eigen::Vector3d total;           ///< [N·m]
  double noise = 0.0;              ///< variance of a component, of sensor and model [N²·m²]

  /// Variance of a component with other currents.
  double variance(const Eigen::VectorXd& currents) const;
};

/// Of all samples with torque.
std::vector<PredictedTorque> predictTorques(const WiringCase& described,
                                            const CalibrationConfig& config);

}  // namespace sac
