#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// What a controller by `model` makes of a wanted torque on an actuator that is `truth`, at one
/// pose: Q_true Q_model⁺ T instead of T.
struct TorqueMatrixError {
  double error = 0.0;  ///< ‖Q_true Q_model⁺ − I‖₂ [1]: largest share by which a torque is missed
  double smallest_singular_value = 0.0;  ///< of Q_true [N·m/A]
  double condition_number = 0.0;         ///< of Q_true [1]
};

/// At the joint sensor angles of each pose [rad], orientation by each one's own joints. Throws
/// ConfigError when one has no torque model.
std::vector<TorqueMatrixError> torqueMatrixErrors(const Actuator& truth,
                                                  const Actuator& model,
                                                  const std::vector<Eigen::Vector3d>& poses);

}  // namespace sac
