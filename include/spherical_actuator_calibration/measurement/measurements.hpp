#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Raw joint sensor reading (topic joint_states): angles of joints 1–3 before calibration [rad].
struct JointMeasurement {
  Stamp stamp = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

/// Measured rotor orientation (topic measured_orientation). The quaternion maps rotor coordinates
/// to stator coordinates; it need not be normalised yet.
struct OrientationMeasurement {
  Stamp stamp = 0;
  Eigen::Quaterniond q_stator_rotor = Eigen::Quaterniond::Identity();
};

/// Torque that the stator exerts on the rotor about its centre, rotor frame (topic measured_torque)
/// [N·m].
struct TorqueMeasurement {
  Stamp stamp = 0;
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
};

/// Measured coil currents in description order (topic coil_currents) [A].
struct CurrentMeasurement {
  Stamp stamp = 0;
  Eigen::VectorXd current;
};

/// Currents that a driver has set, or was commanded, in description order (topics coil_setpoints,
/// coil_command) [A].
struct CurrentCommand {
  Stamp stamp = 0;
  Eigen::VectorXd current;
};

}  // namespace sac
