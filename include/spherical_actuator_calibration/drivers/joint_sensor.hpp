#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/drivers/modbus_link.hpp"
#include "spherical_actuator_calibration/drivers/register_field.hpp"
#include "spherical_actuator_calibration/drivers/register_request.hpp"

namespace sac {

/// Two-axis tilt sensor on the part that joints 1 and 2 move. Channel x reads asin g_y, channel y
/// asin(−g_x), with g the unit vector of gravity's reaction in the sensor (doc/method.md,
/// Laboratory).
struct TiltSensorOptions {
  RegisterField x;  ///< [rad]
  RegisterField y;  ///< [rad]
  /// Inclinations = matrix · readings: scale and cross-axis sensitivity.
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Identity();
};

/// Encoder of one joint [rad].
struct EncoderOptions {
  std::size_t joint = 2;  ///< counted from 0
  RegisterField field;
  /// Counts after which the register begins again; 0: it does not within the joint's range.
  double counts_per_turn = 0.0;
};

/// The joint sensors as a configuration describes them: together they read each joint once.
struct JointSensorOptions {
  ModbusLinkOptions link;
  double rate = 200.0;  ///< of polling [Hz]
  std::optional<TiltSensorOptions> tilt;
  std::vector<EncoderOptions> encoders;
  /// What a calibration identified of the readings, as in a description, which then must not have
  /// it.
  std::array<ReadingCorrection, kJoints> corrections = {};
};

/// Reads a configuration (config/joint_sensor.yaml) from a map whose other keys are the caller's.
/// Throws ConfigError that names the key.
JointSensorOptions readJointSensorOptions(const YamlMap& map);

/// The joint sensors of one machine over a Modbus link. Not thread-safe.
class JointSensor {
 public:
  /// Keeps a reference to the transport.
  JointSensor(const JointSensorOptions& options, ModbusTransport& transport);

  /// Joint angles q [rad] before calibration, but for the corrections of the options. An encoder
  /// that turned through the end of its range goes on; after a silence the turn is the one nearest
  /// to the last angle. Throws TransportError when a device does not answer, DataError when what it
  /// says cannot be.
  Eigen::Vector3d read();

  const std::vector<RegisterRequest>& requests() const { return requests_; }

 private:
  const std::uint16_t* words(const RegisterField& field) const;
  double unwrapped(std::size_t encoder, double angle);

  JointSensorOptions options_;
  JointGeometry corrections_;  ///< nothing else of it
  ModbusTransport& transport_;
  std::vector<RegisterRequest> requests_;
  std::vector<std::vector<std::uint16_t>> answers_;  ///< along with requests_
  std::vector<std::optional<double>> last_angles_;   ///< along with the encoders [rad]
};

/// Inclinations that the channels x and y of a tilt sensor read at joint angles q₁ and q₂ [rad].
Eigen::Vector2d inclinationsOf(const Eigen::Vector2d& q);
/// q₁ and q₂ [rad] of inclinations; nothing when no pose has them.
std::optional<Eigen::Vector2d> jointsOf(const Eigen::Vector2d& inclinations);

/// Words at a place.
struct RegisterContent {
  int unit = 1;
  RegisterTable table = RegisterTable::kHolding;
  int address = 0;
  std::vector<std::uint16_t> words;
};
/// What the devices hold at joint angles [rad]: the inverse of JointSensor::read(), for devices
/// that are emulated. Throws DataError when a value does not fit into its register.
std::vector<RegisterContent> encodeJoints(const JointSensorOptions& options,
                                          const Eigen::Vector3d& corrected);

}  // namespace sac
