#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "emulation/session_scene.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

TEST(SessionSimulator, DefectsOfOneStreamLeaveTheOthersAlone) {
  Scene scene;
  const Recording clean = scene.record();
  scene.options.tracker.stream.dropouts = 2;
  scene.options.tracker.bad_dwells = 1;
  const Recording defective = scene.record();
  EXPECT_LT(defective.poses.size(), clean.poses.size());
  ASSERT_EQ(defective.wrenches.size(), clean.wrenches.size());
  EXPECT_EQ(defective.wrenches.back().torque, clean.wrenches.back().torque);
}

TEST(SessionSimulator, GlitchesAreFarOffAndSingle) {
  Scene scene = exactScene();
  scene.options.tracker.stream.glitches = 5;
  scene.options.wrench_sensor.stream.glitches = 4;
  scene.options.joint_sensor.stream.glitches = 3;
  scene.options.current_sensor.stream.glitches = 2;
  const Recording clean = exactScene().record();
  const Recording recording = scene.record();
  int orientations = 0;
  for (std::size_t n = 0; n < clean.poses.size(); ++n) {
    const Eigen::Matrix3d R_error =
        orientationOf(scene, recording.poses[n]) * orientationOf(scene, clean.poses[n]).transpose();
    const double angle = rotationLog(R_error).norm();
    orientations += std::abs(angle - 0.2) < 1e-9 ? 1 : 0;
  }
  const auto far = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b, double distance) {
    return std::abs((a - b).norm() - distance) < 1e-9 ? 1 : 0;
  };
  int torques = 0;
  for (std::size_t n = 0; n < clean.wrenches.size(); ++n) {
    torques += far(recording.wrenches[n].torque, clean.wrenches[n].torque, 0.5);
  }
  int joints = 0;
  for (std::size_t n = 0; n < clean.joints.size(); ++n) {
    joints += far(recording.joints[n].position, clean.joints[n].position, 0.1);
  }
  int currents = 0;
  for (std::size_t n = 0; n < clean.currents.size(); ++n) {
    currents += far(recording.currents[n].current, clean.currents[n].current, 1.0);
  }
  EXPECT_EQ(orientations, 5);
  EXPECT_EQ(torques, 4);
  EXPECT_EQ(joints, 3);
  EXPECT_EQ(currents, 2);
}

TEST(SessionSimulator, BadDwellsAreOffThroughout) {
  Scene scene = exactScene();
  scene.options.tracker.bad_dwells = 2;
  Recording recording;
  Recorder recorder(recording);
  const SimulatedSession session =
      simulateSession(scene.truth, scene.plan, scene.options, recorder);
  ASSERT_EQ(session.bad_dwells.size(), 2U);
  const std::set<std::size_t> bad(session.bad_dwells.begin(), session.bad_dwells.end());
  SessionTrajectory trajectory = scene.trajectory();
  const JointGeometry joints = jointGeometry(scene.truth.joints);
  for (const MarkerPoseMeasurement& pose : recording.poses) {
    const SessionState& state = trajectory.at(scene.secondsInto(pose.stamp));
    const Eigen::Matrix3d R_true = rotorOrientation(joints, state.joint_position);
    const double angle = rotationLog(orientationOf(scene, pose) * R_true.transpose()).norm();
    const bool off = state.dwell && bad.count(*state.dwell) == 1;
    ASSERT_NEAR(angle, off ? 0.05 : 0.0, 1e-7);
  }
}

TEST(SessionSimulator, TrackerIsOnAtTheFirstPosesOnly) {
  Scene scene;
  scene.options.tracker.poses = 2;
  const Recording recording = scene.record();
  const double end = scene.trajectory().dwells()[1].end;
  EXPECT_NEAR(scene.secondsInto(recording.poses.back().stamp), end, 0.01);
  scene.options.tracker.poses = 0;
  EXPECT_TRUE(scene.record().poses.empty());
}

TEST(SessionSimulator, RepeatedMeasurementsFollowEachOther) {
  Scene scene;
  scene.options.wrench_sensor.stream.repeated_share = 0.1;
  const Recording recording = scene.record();
  int repeated = 0;
  for (std::size_t n = 1; n < recording.wrenches.size(); ++n) {
    if (recording.wrenches[n].stamp == recording.wrenches[n - 1].stamp) {
      ++repeated;
      EXPECT_EQ(recording.wrenches[n].torque, recording.wrenches[n - 1].torque);
    }
  }
  const double share =
      static_cast<double>(repeated) / static_cast<double>(recording.wrenches.size());
  EXPECT_NEAR(share, 0.1 / 1.1, 0.02);
}

TEST(SessionSimulator, ShareOfNaNReachesEveryStream) {
  Scene scene;
  for (StreamOptions* stream : {&scene.options.joint_sensor.stream,
                                &scene.options.tracker.stream,
                                &scene.options.wrench_sensor.stream,
                                &scene.options.current_sensor.stream}) {
    stream->nan_share = 0.05;
  }
  const Recording recording = scene.record();
  const auto share = [](const auto& measurements, const auto& values) {
    const auto defective =
        std::count_if(measurements.begin(), measurements.end(), [&](const auto& measurement) {
          return !values(measurement).allFinite();
        });
    return static_cast<double>(defective) / static_cast<double>(measurements.size());
  };
  constexpr double kTolerance = 0.02;
  EXPECT_NEAR(share(recording.joints, [](const auto& m) { return m.position; }), 0.05, kTolerance);
  EXPECT_NEAR(share(recording.poses, [](const auto& m) { return m.q_tracker_marker.coeffs(); }),
              0.05,
              kTolerance);
  EXPECT_NEAR(share(recording.wrenches, [](const auto& m) { return m.torque; }), 0.05, kTolerance);
  EXPECT_NEAR(share(recording.currents, [](const auto& m) { return m.current; }), 0.05, kTolerance);
}

}  // namespace
}  // namespace sac
