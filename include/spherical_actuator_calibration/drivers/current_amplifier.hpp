#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/drivers/current_limiter.hpp"
#include "spherical_actuator_calibration/drivers/current_supervisor.hpp"
#include "spherical_actuator_calibration/drivers/modbus_link.hpp"
#include "spherical_actuator_calibration/drivers/register_field.hpp"

namespace sac {

/// The current amplifier of all coils, and how it is driven, as a configuration describes them.
/// Blocks hold one number per coil, in description order, from the field's address on.
struct CurrentAmplifierOptions {
  ModbusLinkOptions link;  ///< its response timeout is also that of all requests of a beat
  double rate = 200.0;     ///< of the control loop [Hz]
  SupervisorLimits supervision;
  CurrentLimits limits;
  RegisterField setpoints;  ///< block of holding registers [A]
  RegisterField currents;   ///< block of measured currents [A]
  /// Holding register that is 1 while the output stages are on, 0 otherwise.
  std::optional<int> enable_address;
  /// Register that is not 0 when the amplifier has tripped.
  std::optional<RegisterField> tripped;
  /// Holding register that is counted up with every setpoint, for the amplifier's own watchdog.
  /// Only an operator who accepts that nothing ends the currents when the driver is killed goes
  /// without.
  std::optional<int> heartbeat_address;
  /// More memory than it has at its start the program that drives it must not take [MB]. One lying
  /// length on a link of ROS asks for up to 1000.
  double memory_limit = 2000.0;
};

/// Reads a configuration (config/coil_driver.yaml) from a map whose other keys are the caller's.
/// Throws ConfigError that names the key.
CurrentAmplifierOptions readCurrentAmplifierOptions(const YamlMap& map);

/// Whether the amplifier's output stages are switched on.
enum class OutputStages { kOff, kOn };

/// Whether the amplifier's own watchdog is told that all is well.
enum class Heartbeat { kGiven, kWithheld };

/// The current amplifier over a Modbus link. Not thread-safe.
class CurrentAmplifier {
 public:
  /// Keeps a reference to the transport. Throws ConfigError when registers overlap: then a
  /// heartbeat would be a setpoint, or a setpoint its own measurement.
  CurrentAmplifier(const CurrentAmplifierOptions& options,
                   std::size_t coils,
                   ModbusTransport& transport);

  /// Sets the current of every coil [A], then switches the output stages, where they can be. Throws
  /// TransportError, and DataError when a current does not fit into its register: then none is
  /// written.
  void write(const Eigen::VectorXd& currents,
             OutputStages stages,
             Heartbeat heartbeat = Heartbeat::kGiven);
  /// Measured current of every coil [A]. Throws TransportError, also when one is not finite.
  Eigen::VectorXd read();
  /// Whether the amplifier says that it has tripped; false where it cannot say. Throws
  /// TransportError.
  bool isTripped();
  /// Output stages off, where they can be switched. Throws TransportError.
  void switchOff();
  /// Zero currents. Throws TransportError.
  void zero();

 private:
  void writeSetpoints(const std::vector<std::uint16_t>& words);

  CurrentAmplifierOptions options_;
  std::size_t coils_;
  ModbusTransport& transport_;
  std::optional<OutputStages> stages_;  ///< as written last; nothing: not known
  std::uint16_t heartbeat_ = 0;
};

}  // namespace sac
