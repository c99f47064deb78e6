#include "spherical_actuator_calibration/measurement/registration.hpp"

namespace sac {
namespace {

/// Torque about the origin of a body, in the body's frame, of a wrench on a sensor fixed to it.
Eigen::Vector3d torqueAboutCentre(const Eigen::Isometry3d& X_body_sensor,
                                  const WrenchMeasurement& wrench) {
  const auto R_body_sensor = X_body_sensor.linear();
  const Eigen::Vector3d lever_body = X_body_sensor.translation();
  const Eigen::Vector3d force_body = R_body_sensor * wrench.force;
  return R_body_sensor * wrench.torque + lever_body.cross(force_body);
}

}  // namespace

OrientationMeasurement orientationFromMarkerPose(const Registration& registration,
                                                 const MarkerPoseMeasurement& pose) {
  const Eigen::Quaterniond q_stator_tracker(registration.X_stator_tracker.linear());
  const Eigen::Quaterniond q_rotor_marker(registration.X_rotor_marker.linear());
  return {pose.stamp, q_stator_tracker * pose.q_tracker_marker * q_rotor_marker.conjugate()};
}

MarkerPoseMeasurement markerPoseFromOrientation(const Registration& registration,
                                                Stamp stamp,
                                                const Eigen::Matrix3d& R_stator_rotor) {
  Eigen::Isometry3d X_stator_rotor = Eigen::Isometry3d::Identity();
  X_stator_rotor.linear() = R_stator_rotor;
  const Eigen::Isometry3d X_tracker_marker =
      registration.X_stator_tracker.inverse() * X_stator_rotor * registration.X_rotor_marker;
  return {stamp, X_tracker_marker.translation(), Eigen::Quaterniond(X_tracker_marker.linear())};
}

TorqueMeasurement torqueFromWrench(const Registration& registration,
                                   const WrenchMeasurement& wrench) {
  return {wrench.stamp, torqueAboutCentre(registration.X_rotor_sensor, wrench)};
}

TorqueMeasurement torqueFromStatorWrench(const Eigen::Isometry3d& X_stator_sensor,
                                         const Eigen::Quaterniond& q_stator_rotor,
                                         const WrenchMeasurement& wrench) {
  const Eigen::Vector3d torque_stator = torqueAboutCentre(X_stator_sensor, wrench);
  return {wrench.stamp, -(q_stator_rotor.conjugate() * torque_stator)};
}

WrenchMeasurement wrenchFromTorque(const Registration& registration,
                                   const TorqueMeasurement& torque,
                                   const Eigen::Vector3d& force_rotor) {
  const Eigen::Matrix3d R_sensor_rotor = registration.X_rotor_sensor.linear().transpose();
  const Eigen::Vector3d lever_rotor = registration.X_rotor_sensor.translation();
  return {torque.stamp,
          R_sensor_rotor * force_rotor,
          R_sensor_rotor * (torque.torque - lever_rotor.cross(force_rotor))};
}

}  // namespace sac
