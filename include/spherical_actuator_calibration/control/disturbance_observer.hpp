#pragma once

#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {

/// Of DisturbanceObserver.
struct DisturbanceObserverOptions {
  /// With which a torque that nobody told of is found [rad/s]; 0: it is not looked for.
  double bandwidth = 10.0;
  double largest_torque = 0.03;  ///< that is found at most [N·m]
};

/// Faster, it would act within the lag of currents and velocities.
ValueRange disturbanceBandwidthRange();

/// Throws ConfigError that names the option and its range.
void validate(const DisturbanceObserverOptions& options);

/// What a cycle may do to the torque that was found.
enum class Learning {
  kFree,
  kNoGrowth,  ///< it may only become less
  kNone,
};

/// Finds the torque on a rotor that neither the model nor the currents explain, a load for
/// instance, from how its momentum changes: d = J dω/dt + ω × Jω − T_coils − T_gravity through a
/// low-pass filter. As it looks at torques rather than at the error of a control, a reference that
/// moves makes it find nothing. Rotor frame, [N·m]. Not thread-safe.
class DisturbanceObserver {
 public:
  /// `velocity_cutoff` [rad/s] of the first-order filter that velocities went through: torques go
  /// through the same. Throws ConfigError when an option is not valid.
  DisturbanceObserver(const DisturbanceObserverOptions& options, double velocity_cutoff);

  /// Nothing is known.
  void reset();
  /// What was found stays; the next state does not follow the last one.
  void interrupt() { before_.reset(); }
  /// The state `step` > 0 [s] after that of the last call, and the torque of the coils since then.
  void update(double step,
              const RigidRotor& rotor,
              const RotorState& state,
              const Eigen::Vector3d& coil_torque,
              Learning learning);

  const Eigen::Vector3d& torque() const { return torque_; }

 private:
  struct Before {
    Eigen::Vector3d angular_velocity;  ///< rotor frame [rad/s]
    Eigen::Vector3d coil_torque;       ///< filtered as velocities are
  };

  DisturbanceObserverOptions options_;
  double velocity_cutoff_;
  std::optional<Before> before_;
  Eigen::Vector3d torque_ = Eigen::Vector3d::Zero();
};

}  // namespace sac
