#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Where the measuring devices sit. `X_a_b` maps coordinates of frame b to frame a.
struct Registration {
  Eigen::Isometry3d X_stator_tracker = Eigen::Isometry3d::Identity();  ///< base of the tracker
  Eigen::Isometry3d X_rotor_marker = Eigen::Isometry3d::Identity();    ///< body that it tracks
  Eigen::Isometry3d X_rotor_sensor = Eigen::Isometry3d::Identity();    ///< force/torque sensor
};

/// Pose of `marker` in `tracker` (topic tracker/pose). The quaternion need not be normalised.
struct MarkerPoseMeasurement {
  Stamp stamp = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of marker, in tracker [m]
  Eigen::Quaterniond q_tracker_marker = Eigen::Quaterniond::Identity();
};

/// Wrench that acts on the rotor, about the origin of frame `ft_sensor` and expressed in it (topic
/// ft_sensor/wrench).
struct WrenchMeasurement {
  Stamp stamp = 0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N·m]
};

/// Rotor orientation of a tracker pose. The norm of the measured quaternion is kept, so that a
/// defect of it stays visible.
OrientationMeasurement orientationFromMarkerPose(const Registration& registration,
                                                 const MarkerPoseMeasurement& pose);

/// Tracker pose of a rotor orientation: the inverse of orientationFromMarkerPose(). The origins of
/// stator and rotor coincide.
MarkerPoseMeasurement markerPoseFromOrientation(const Registration& registration,
                                                Stamp stamp,
                                                const Eigen::Matrix3d& R_stator_rotor);

/// Torque about the rotor centre, in the rotor frame, of a wrench measured away from it:
/// T_c = R (T_s + p × F) with p the sensor's origin from the rotor centre, in the sensor frame
/// (doc/method.md, Laboratory). A plain rotation of the wrench would lose the lever arm.
TorqueMeasurement torqueFromWrench(const Registration& registration,
                                   const WrenchMeasurement& wrench);

/// The same for a sensor that carries the stator, `X_stator_sensor` its place: what it feels acts
/// on the stator and is the rotor's reaction, T_c = −R_rotor_stator R_stator_sensor (T_s + p × F).
TorqueMeasurement torqueFromStatorWrench(const Eigen::Isometry3d& X_stator_sensor,
                                         const Eigen::Quaterniond& q_stator_rotor,
                                         const WrenchMeasurement& wrench);

/// Wrench in the sensor frame of a torque about the rotor centre and a force, both in the rotor
/// frame: the inverse of torqueFromWrench().
WrenchMeasurement wrenchFromTorque(const Registration& registration,
                                   const TorqueMeasurement& torque,
                                   const Eigen::Vector3d& force_rotor);

}  // namespace sac
