#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/usual_currents.hpp"

namespace sac {

/// How a torque is shared among coils.
struct AllocationOptions {
  double current_limit = kUsualCoilCurrent;  ///< of each coil [A], > 0
  /// Smallest singular value of Q at which a torque is still made [N·m/A]: below it currents would
  /// be large and their torque uncertain.
  double least_singular_value = 0.05;
};

/// What became of a wanted torque.
enum class Allocation {
  kReached,   ///< the currents make the torque
  kLimited,   ///< more than the limits allow: what they do allow along its direction, to 0.1 %
  kSingular,  ///< no torque in some direction at this orientation: no current
};

/// What allocateCurrents() finds.
struct AllocatedCurrents {
  Allocation outcome = Allocation::kSingular;
  Eigen::VectorXd currents;              ///< of every coil [A], within the limits
  double share = 0.0;                    ///< of the torque that they make, 0 to 1
  double smallest_singular_value = 0.0;  ///< of Q [N·m/A]
};

/// Currents of least power that make a torque [N·m, rotor frame], with Q the torque per ampere of
/// each coil (3×l, torquePerAmpere()): the minimum-norm solution Qᵀ(QQᵀ)⁻¹T where it is within the
/// limits, else the solution of min ‖I‖² with QI = T, |I| ≤ limit, by its dual in three variables.
/// Throws ConfigError when an option is not valid, DataError when torque or Q is not finite.
AllocatedCurrents allocateCurrents(const Eigen::Matrix3Xd& torque_per_ampere,
                                   const Eigen::Vector3d& torque,
                                   const AllocationOptions& options);

}  // namespace sac
