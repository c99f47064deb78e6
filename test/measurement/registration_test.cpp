#include "spherical_actuator_calibration/measurement/registration.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/emulation/session_simulator.hpp"

namespace sac {
namespace {

Eigen::Matrix3d someOrientation() {
  return rotationExp({0.3, -0.8, 1.9});
}

TEST(Registration, OrientationComesThroughTrackerAndMarker) {
  // Tracker turned a quarter about z, marker a quarter about x: by hand.
  Registration registration;
  registration.X_stator_tracker.linear() = rotationExp({0.0, 0.0, kPi / 2.0});
  registration.X_rotor_marker.linear() = rotationExp({kPi / 2.0, 0.0, 0.0});
  const MarkerPoseMeasurement pose{7, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()};
  const OrientationMeasurement orientation = orientationFromMarkerPose(registration, pose);
  Eigen::Matrix3d R_expected;
  R_expected << 0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  EXPECT_LT((orientation.q_stator_rotor.toRotationMatrix() - R_expected).norm(), 1e-15);
  EXPECT_EQ(orientation.stamp, 7);
}

TEST(Registration, TrackerPoseOfAnOrientationGivesItBack) {
  const Registration registration = laboratoryRegistration();
  const MarkerPoseMeasurement pose = markerPoseFromOrientation(registration, 7, someOrientation());
  const OrientationMeasurement orientation = orientationFromMarkerPose(registration, pose);
  EXPECT_LT((orientation.q_stator_rotor.toRotationMatrix() - someOrientation()).norm(), 1e-14);
  const Eigen::Vector3d marker_stator = registration.X_stator_tracker * pose.position;
  const Eigen::Vector3d marker_rotor = registration.X_rotor_marker.translation();
  EXPECT_LT((marker_stator - someOrientation() * marker_rotor).norm(), 1e-14);
}

TEST(Registration, DefectsOfTheMeasuredQuaternionStayVisible) {
  const Registration registration = laboratoryRegistration();
  MarkerPoseMeasurement pose = markerPoseFromOrientation(registration, 0, someOrientation());
  pose.q_tracker_marker.coeffs() *= 1.01;
  EXPECT_NEAR(orientationFromMarkerPose(registration, pose).q_stator_rotor.norm(), 1.01, 1e-12);
  pose.q_tracker_marker.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(orientationFromMarkerPose(registration, pose)
                   .q_stator_rotor.coeffs()
                   .array()
                   .isFinite()
                   .all());
}

TEST(Registration, LeverArmEntersTheTorque) {
  // A sensor 0.1 m above the centre, turned a quarter about z, feels 2 N along its x: that is along
  // y of the rotor, and turns the rotor about −x.
  Registration registration;
  registration.X_rotor_sensor.linear() = rotationExp({0.0, 0.0, kPi / 2.0});
  registration.X_rotor_sensor.translation() = Eigen::Vector3d(0.0, 0.0, 0.1);
  const WrenchMeasurement wrench{9, {2.0, 0.0, 0.0}, {0.05, 0.0, 0.0}};
  const TorqueMeasurement torque = torqueFromWrench(registration, wrench);
  EXPECT_LT((torque.torque - Eigen::Vector3d(-0.2, 0.05, 0.0)).norm(), 1e-15);
  EXPECT_EQ(torque.stamp, 9);
}

TEST(Registration, SensorUnderTheStatorFeelsTheReaction) {
  // The stator turns the rotor about z; a sensor 0.1 m below the centre feels the opposite, and 2 N
  // along x that turn the stator about −y, hence the rotor about y. The rotor lies a quarter about
  // z, so that its x is the stator's y.
  Eigen::Isometry3d X_stator_sensor = Eigen::Isometry3d::Identity();
  X_stator_sensor.translation() = Eigen::Vector3d(0.0, 0.0, -0.1);
  const Eigen::Quaterniond q_stator_rotor(rotationExp({0.0, 0.0, kPi / 2.0}));
  const WrenchMeasurement wrench{9, {2.0, 0.0, 0.0}, {0.0, 0.0, -0.5}};
  const TorqueMeasurement torque = torqueFromStatorWrench(X_stator_sensor, q_stator_rotor, wrench);
  EXPECT_LT((torque.torque - Eigen::Vector3d(0.2, 0.0, 0.5)).norm(), 1e-15);
  EXPECT_EQ(torque.stamp, 9);
}

TEST(Registration, WrenchOfATorqueGivesItBack) {
  const Registration registration = laboratoryRegistration();
  const Eigen::Vector3d torque(0.1, -0.2, 0.3);
  const Eigen::Vector3d force(-4.0, 5.0, 6.0);
  const WrenchMeasurement wrench = wrenchFromTorque(registration, {3, torque}, force);
  EXPECT_LT((torqueFromWrench(registration, wrench).torque - torque).norm(), 1e-15);
  EXPECT_LT((registration.X_rotor_sensor.linear() * wrench.force - force).norm(), 1e-14);
}

}  // namespace
}  // namespace sac
