#pragma once

#include <cstdint>
#include <string>

#include <ros/node_handle.h>

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"
#include "spherical_actuator_calibration/drivers/joint_sensor.hpp"
#include "spherical_actuator_calibration/emulation/emulated_amplifier.hpp"
#include "spherical_actuator_calibration/emulation/emulated_sensors.hpp"
#include "spherical_actuator_calibration/emulation/laboratory_history.hpp"
#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "spherical_actuator_calibration/emulation/positioning_fixture.hpp"
#include "spherical_actuator_calibration/emulation/rotor_friction.hpp"
#include "spherical_actuator_calibration/emulation/true_actuator.hpp"
#include "spherical_actuator_calibration/measurement/registration.hpp"

namespace sac {

/// The emulated laboratory as configured (config/lab_emulator.yaml).
struct LabEmulatorOptions {
  std::uint64_t seed = 1;  ///< of the unit's errors and of all noise
  std::string truth;       ///< file to write the true parameters to; empty: none
  ManufacturingErrors errors;
  RotorLoad load;
  Eigen::Matrix3d inertia = RigidRotor{}.inertia;  ///< of rotor and load, rotor frame [kg·m²]
  BearingFriction friction;                        ///< of a released rotor
  StreamDelays delays;
  FixtureOptions fixture;
  double mechanical_stop = 0.9;  ///< of joints 1 and 2 of a released rotor [rad]
  AmplifierDynamics amplifier;

  std::string stator_frame = "stator";
  std::string tracker_frame = "tracker";
  std::string ft_sensor_frame = "ft_sensor";
  Registration registration;  ///< the true one

  EmulatedJointOptions joints;
  TrackerOptions tracker;
  WrenchSensorOptions ft_sensor;
  CurrentSensorOptions currents;

  /// Registers: the configurations of the drivers that will read them.
  JointSensorOptions joint_sensor;
  CurrentAmplifierOptions coil_driver;
};

/// Loads the private parameters of the node. Throws ConfigError that names the key.
LabEmulatorOptions loadLabEmulatorOptions(const ros::NodeHandle& private_node);

}  // namespace sac
