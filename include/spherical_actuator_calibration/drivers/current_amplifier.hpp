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
#include "spherical_actuator_calibration/drivers/register_request.hpp"

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
  /// Setpoints, heartbeat, `currents` and `tripped` go by one request (function 23), where the
  /// output stages stay as they are.
  bool one_request = false;
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

/// What an amplifier tells of its coils.
struct AmplifierReading {
  Eigen::VectorXd currents;  ///< measured, of every coil [A]
  bool tripped = false;      ///< it said so in the same answer
  double duration = 0.0;     ///< of the requests that read the currents [s]
  /// From the middle of the requests that wrote the setpoints to the end; 0: none was written [s].
  double since_set = 0.0;
};

/// The current amplifier over a Modbus link. Not thread-safe.
class CurrentAmplifier {
 public:
  /// Keeps a reference to the transport. Throws ConfigError when registers overlap: then a
  /// heartbeat would be a setpoint, or a setpoint its own measurement; and when they are not such
  /// that one request holds them, where that is asked for.
  CurrentAmplifier(const CurrentAmplifierOptions& options,
                   std::size_t coils,
                   ModbusTransport& transport);

  /// Sets the current of every coil [A], then switches the output stages, where they can be. Throws
  /// TransportError, and DataError when a current does not fit into its register: then none is
  /// written.
  void write(const Eigen::VectorXd& currents,
             OutputStages stages,
             Heartbeat heartbeat = Heartbeat::kGiven);
  /// Throws TransportError, also when a current is not finite.
  AmplifierReading read();
  /// write(), then read(): by one request where that is asked for. Throws what they do.
  AmplifierReading exchange(const Eigen::VectorXd& currents,
                            OutputStages stages,
                            Heartbeat heartbeat);
  /// Whether the amplifier says that it has tripped; false where it cannot say. Throws
  /// TransportError.
  bool isTripped();
  /// Whether isTripped() has nothing to tell: readings tell it, or the amplifier cannot. While the
  /// output stages are off it has: before they are switched on.
  bool tellsTripsByReadings() const;
  /// Output stages off, where they can be switched. Throws TransportError.
  void switchOff();
  /// Zero currents. Throws TransportError.
  void zero();
  /// Its heartbeat alone, where it has one. Throws TransportError.
  void feed();

 private:
  using Words = std::vector<std::uint16_t>;

  void requireOneRequest() const;
  Words setpointWords(const Eigen::VectorXd& currents) const;
  /// Whether a heartbeat right after the setpoints goes with them.
  bool isHeartbeatNext() const;
  void writeSetpoints(const Words& words);
  void switchStages(OutputStages stages);
  Eigen::VectorXd decoded(const std::uint16_t* words) const;
  AmplifierReading readingOf(const Words& words) const;

  CurrentAmplifierOptions options_;
  std::size_t coils_;
  ModbusTransport& transport_;
  /// What reads `currents` and `tripped` at once, where they are neighbours or one request is asked
  /// for.
  std::optional<RegisterRequest> joined_;
  std::optional<OutputStages> stages_;  ///< as written last; nothing: not known
  std::uint16_t heartbeat_ = 0;
};

}  // namespace sac
