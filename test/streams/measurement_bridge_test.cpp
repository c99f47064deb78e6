#include "spherical_actuator_calibration/streams/measurement_bridge.hpp"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/emulation/session_simulator.hpp"
#include "streams/example_stamps.hpp"
#include "support/error_message.hpp"
#include "support/not_a_number.hpp"

namespace sac {
namespace {

/// The rotor turns about z by this much in a period.
constexpr double kTurn = 0.01;

Eigen::Matrix3d orientationAt(double periods) {
  return rotationExp({0.0, 0.0, kTurn * periods});
}

MarkerPoseMeasurement poseAt(int period) {
  return markerPoseFromOrientation(
      laboratoryRegistration(), kNow + period * kPeriod, orientationAt(period));
}

WrenchMeasurement wrenchAt(double periods) {
  return {kNow + static_cast<Stamp>(periods * kPeriod), {1.0, -2.0, 3.0}, {0.1, 0.2, -0.3}};
}

MeasurementBridgeOptions onStator() {
  MeasurementBridgeOptions options;
  options.sensor_mount = SensorMount::kStator;
  return options;
}

/// A bridge with the registration of the laboratory.
class Bridge {
 public:
  explicit Bridge(const MeasurementBridgeOptions& options = {}) : bridge_(options) {}

  OrientationMeasurement orientation(const MarkerPoseMeasurement& pose) {
    return bridge_.orientation(pose, registration_.X_stator_tracker, registration_.X_rotor_marker);
  }
  void add(const WrenchMeasurement& wrench) { bridge_.add(wrench, registration_.X_rotor_sensor); }
  MeasurementBridge::Torques takeTorques() { return bridge_.takeTorques(); }
  std::uint64_t clockResets() const { return bridge_.clockResets(); }

  std::string refusal(const MarkerPoseMeasurement& pose) {
    return errorMessage<DataError>([&] { orientation(pose); });
  }
  std::string refusal(const WrenchMeasurement& wrench) {
    return errorMessage<DataError>([&] { add(wrench); });
  }

 private:
  Registration registration_ = laboratoryRegistration();
  MeasurementBridge bridge_;
};

TEST(MeasurementBridge, GivesTheOrientationOfThePose) {
  Bridge bridge;
  for (int period = 0; period < 100; ++period) {
    const OrientationMeasurement orientation = bridge.orientation(poseAt(period));
    EXPECT_EQ(orientation.stamp, kNow + period * kPeriod);
    EXPECT_LT((orientation.q_stator_rotor.toRotationMatrix() - orientationAt(period)).norm(),
              1e-14);
  }
}

TEST(MeasurementBridge, GivesTheTorqueOfAWrenchOnTheRotorAtOnce) {
  Bridge bridge;
  bridge.add(wrenchAt(0));
  bridge.add(wrenchAt(1));
  const MeasurementBridge::Torques torques = bridge.takeTorques();
  ASSERT_EQ(torques.measurements.size(), 2u);
  const TorqueMeasurement expected = torqueFromWrench(laboratoryRegistration(), wrenchAt(1));
  EXPECT_EQ(torques.measurements[1].stamp, expected.stamp);
  EXPECT_EQ(torques.measurements[1].torque, expected.torque);
  EXPECT_TRUE(bridge.takeTorques().measurements.empty());
}

TEST(MeasurementBridge, RefusesWhatIsNotFinite) {
  Bridge bridge;
  MarkerPoseMeasurement pose = poseAt(0);
  pose.q_tracker_marker.y() = kNaN;
  EXPECT_NE(bridge.refusal(pose).find("not finite"), std::string::npos);
  pose = poseAt(0);
  pose.position.z() = kNaN;
  EXPECT_NE(bridge.refusal(pose).find("not finite"), std::string::npos);
  WrenchMeasurement wrench = wrenchAt(0);
  wrench.force.x() = std::numeric_limits<double>::infinity();
  EXPECT_NE(bridge.refusal(wrench).find("not finite"), std::string::npos);
  wrench = wrenchAt(0);
  wrench.torque.x() = kNaN;
  EXPECT_NE(bridge.refusal(wrench).find("not finite"), std::string::npos);
  EXPECT_TRUE(bridge.takeTorques().measurements.empty());
  // None of their stamps counts.
  EXPECT_NO_THROW(bridge.orientation(poseAt(0)));
  EXPECT_NO_THROW(bridge.add(wrenchAt(0)));
}

TEST(MeasurementBridge, RefusesQuaternionsThatAreNoRotation) {
  Bridge bridge;
  MarkerPoseMeasurement pose = poseAt(0);
  pose.q_tracker_marker.coeffs() *= 1.0011;
  EXPECT_NE(bridge.refusal(pose).find("norm"), std::string::npos);
  pose.q_tracker_marker.coeffs().setZero();
  EXPECT_NE(bridge.refusal(pose).find("norm"), std::string::npos);
  pose = poseAt(0);
  pose.q_tracker_marker.coeffs() *= 1.0009;
  EXPECT_NO_THROW(bridge.orientation(pose));
}

TEST(MeasurementBridge, RefusesStampsThatDoNotIncrease) {
  Bridge bridge;
  bridge.orientation(poseAt(5));
  EXPECT_NE(bridge.refusal(poseAt(5)).find("repeated"), std::string::npos);
  EXPECT_NE(bridge.refusal(poseAt(4)).find("late"), std::string::npos);
  bridge.add(wrenchAt(5));
  EXPECT_NE(bridge.refusal(wrenchAt(5)).find("repeated"), std::string::npos);
  EXPECT_NE(bridge.refusal(wrenchAt(4)).find("late"), std::string::npos);
  EXPECT_EQ(bridge.clockResets(), 0u);
}

TEST(MeasurementBridge, GoesOnAfterAResetOfTheClock) {
  for (const SensorMount mount : {SensorMount::kRotor, SensorMount::kStator}) {
    MeasurementBridgeOptions options;
    options.sensor_mount = mount;
    Bridge bridge(options);
    bridge.orientation(poseAt(1000));
    bridge.add(wrenchAt(1000));
    // The first of each stream after it waits for the second to confirm it.
    EXPECT_NE(bridge.refusal(poseAt(0)).find("leaps"), std::string::npos);
    EXPECT_NE(bridge.refusal(wrenchAt(0)).find("leaps"), std::string::npos);
    EXPECT_NO_THROW(bridge.orientation(poseAt(1)));
    EXPECT_NO_THROW(bridge.add(wrenchAt(1)));
    EXPECT_EQ(bridge.clockResets(), 2u);
    bridge.takeTorques();
    for (int period = 2; period < 5; ++period) {
      EXPECT_NO_THROW(bridge.orientation(poseAt(period)));
    }
    bridge.add(wrenchAt(4));
    EXPECT_EQ(bridge.takeTorques().measurements.size(), 1u);
  }
}

TEST(MeasurementBridge, RefusesAJumpUntilItIsConfirmed) {
  MeasurementBridgeOptions options;
  options.jumps.confirmations = 4;
  options.jumps.largest_rate = 5.0;
  Bridge bridge(options);
  const auto pose = [](int period, double angle) {
    return markerPoseFromOrientation(
        laboratoryRegistration(), kNow + period * kPeriod, rotationExp({angle, 0.0, 0.0}));
  };
  bridge.orientation(pose(0, 0.0));
  // One that is far off costs itself alone.
  EXPECT_NE(bridge.refusal(pose(1, 1.0)).find("jumped"), std::string::npos);
  EXPECT_NO_THROW(bridge.orientation(pose(2, 0.01)));
  // Those that contradict each other confirm nothing.
  for (int period = 3; period < 13; ++period) {
    EXPECT_NE(bridge.refusal(pose(period, period % 2 == 0 ? 1.5 : -1.5)).find("jumped"),
              std::string::npos);
  }
  EXPECT_NO_THROW(bridge.orientation(pose(13, 0.0)));
  // Those that agree do, at the fourth.
  for (int period = 14; period < 17; ++period) {
    EXPECT_NE(bridge.refusal(pose(period, 2.5)).find("jumped"), std::string::npos);
  }
  EXPECT_NO_THROW(bridge.orientation(pose(17, 2.5)));
  EXPECT_NO_THROW(bridge.orientation(pose(18, 2.5)));
}

TEST(MeasurementBridge, TakesWhatTheRotorCanDo) {
  MeasurementBridgeOptions options;
  options.jumps.largest_rate = 2.0;
  options.jumps.tolerance = 0.001;
  const auto pose = [](double angle, double seconds) {
    const auto stamp = kNow + static_cast<Stamp>(seconds * 1e9);
    return markerPoseFromOrientation(
        laboratoryRegistration(), stamp, rotationExp({0.0, angle, 0.0}));
  };
  Bridge slow_enough(options);
  slow_enough.orientation(pose(0.0, 0.0));
  EXPECT_NO_THROW(slow_enough.orientation(pose(0.2, 0.1)));
  EXPECT_NO_THROW(slow_enough.orientation(pose(1.1, 0.6)));
  Bridge too_fast(options);
  too_fast.orientation(pose(0.0, 0.0));
  EXPECT_NE(too_fast.refusal(pose(0.202, 0.1)), "no exception");
  Bridge other_sign(options);
  MarkerPoseMeasurement negated = pose(0.0, 0.1);
  negated.q_tracker_marker.coeffs() *= -1.0;
  other_sign.orientation(pose(0.0, 0.0));
  EXPECT_NO_THROW(other_sign.orientation(negated));
}

TEST(MeasurementBridge, TurnsATorqueOnTheStatorIntoTheRotorAtItsStamp) {
  Bridge bridge(onStator());
  bridge.orientation(poseAt(0));
  bridge.add(wrenchAt(0));
  bridge.add(wrenchAt(0.25));
  bridge.add(wrenchAt(1));
  bridge.add(wrenchAt(1.5));
  bridge.orientation(poseAt(1));
  const MeasurementBridge::Torques torques = bridge.takeTorques();
  EXPECT_TRUE(torques.refusals.empty());
  ASSERT_EQ(torques.measurements.size(), 3u);
  constexpr double kPeriods[] = {0.0, 0.25, 1.0};
  for (std::size_t k = 0; k < 3; ++k) {
    // The reaction on the stator, about the centre in the stator, seen from the rotor.
    const Eigen::Isometry3d X_stator_sensor = laboratoryRegistration().X_rotor_sensor;
    const WrenchMeasurement wrench = wrenchAt(kPeriods[k]);
    const Eigen::Vector3d force = X_stator_sensor.linear() * wrench.force;
    const Eigen::Vector3d torque = X_stator_sensor.linear() * wrench.torque;
    const Eigen::Vector3d reaction = torque + X_stator_sensor.translation().cross(force);
    const Eigen::Vector3d expected = -(orientationAt(kPeriods[k]).transpose() * reaction);
    EXPECT_EQ(torques.measurements[k].stamp, wrench.stamp);
    EXPECT_LT((torques.measurements[k].torque - expected).norm(), 1e-14);
  }
  bridge.orientation(poseAt(2));
  EXPECT_EQ(bridge.takeTorques().measurements.size(), 1u);
}

TEST(MeasurementBridge, RefusesWrenchesOnTheStatorThatNoOrientationSurrounds) {
  Bridge bridge(onStator());
  bridge.add(wrenchAt(-1));
  bridge.orientation(poseAt(0));
  EXPECT_EQ(bridge.takeTorques().refusals.size(), 1u);  // older than every orientation
  bridge.add(wrenchAt(5));
  bridge.orientation(poseAt(11));
  EXPECT_EQ(bridge.takeTorques().refusals.size(), 1u);  // in a hole
  bridge.add(wrenchAt(12));
  bridge.add(wrenchAt(62));
  EXPECT_TRUE(bridge.takeTorques().refusals.empty());
  bridge.add(wrenchAt(63));
  EXPECT_EQ(bridge.takeTorques().refusals.size(), 1u);  // waited in vain
  EXPECT_TRUE(bridge.takeTorques().measurements.empty());
}

}  // namespace
}  // namespace sac
