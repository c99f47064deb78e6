#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include <Eigen/Core>

#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"
#include "spherical_actuator_calibration/emulation/modbus_server.hpp"

namespace sac {

/// How an emulated amplifier behaves.
struct AmplifierDynamics {
  double time_constant = 2e-3;  ///< of the currents' first-order lag [s]
  /// Its own watchdog, where there is a heartbeat register: so long without a change of it the
  /// currents go to zero [s].
  double watchdog = 0.5;
  double delay = 0.0;  ///< from a setpoint to the begin of its effect [s]
};

/// Throws ConfigError that names the option, its value and the allowed range.
void validate(const AmplifierDynamics& dynamics);

/// The current amplifier that a CurrentAmplifier drives, behind the registers of its configuration.
/// Not thread-safe by itself; its registers may be read and written at any time.
class EmulatedAmplifier {
 public:
  /// Adds its units to `server`, which must outlive it.
  EmulatedAmplifier(const CurrentAmplifierOptions& options,
                    const AmplifierDynamics& dynamics,
                    std::size_t coils,
                    ModbusServer& server);

  /// On by `step` ≥ 0 [s], throughout which its registers were as they are now.
  void advance(double step);
  /// A tripped amplifier has no current and says so.
  void setTripped(bool tripped);

  const Eigen::VectorXd& currents() const { return currents_; }  ///< actual ones [A]
  /// What its current measurement reads [A]. Throws DataError when one does not fit its register.
  void show(const Eigen::VectorXd& measured);

 private:
  /// What the output stages are told to reach from a time on.
  struct Order {
    double time = 0.0;  ///< [s]
    Eigen::VectorXd currents;
  };

  void approach(const Eigen::VectorXd& wanted, double step);
  bool isOn(double step);
  Eigen::VectorXd setpoints() const;

  CurrentAmplifierOptions options_;
  AmplifierDynamics dynamics_;
  std::size_t coils_;
  ModbusServer& server_;
  Eigen::VectorXd currents_;
  double time_ = 0.0;         ///< since its begin [s]
  std::deque<Order> orders_;  ///< the one in force, then those to come
  bool tripped_ = false;
  std::uint16_t heartbeat_ = 0;
  double heartbeat_age_ = 0.0;  ///< [s]
};

}  // namespace sac
