#include "spherical_actuator_calibration/emulation/session_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "emulation/session_scene.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"

namespace sac {
namespace {

/// Largest torque that the truth leaves unexplained, about the rotor centre [N·m].
template <typename Explained>
double largestTorqueResidual(const Scene& scene, const Explained& explained) {
  const TorqueCurve curve(*scene.truth.torque_curve);
  const TorqueGeometry geometry = torqueGeometry(scene.truth);
  const JointGeometry joints = jointGeometry(scene.truth.joints);
  SessionTrajectory trajectory = scene.trajectory();
  double largest = 0.0;
  for (const WrenchMeasurement& wrench : scene.record().wrenches) {
    const SessionState& state = trajectory.at(scene.secondsInto(wrench.stamp));
    const Eigen::Matrix3d R = rotorOrientation(joints, state.joint_position);
    const Eigen::Vector3d expected = rotorTorque(curve, geometry, R, state.current) + explained(R);
    const Eigen::Vector3d measured = torqueFromWrench(scene.options.registration, wrench).torque;
    largest = std::max(largest, (measured - expected).norm());
  }
  return largest;
}

/// Equal in every component, where NaN equals NaN.
bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a.array() == b.array() || (a.array().isNaN() && b.array().isNaN())).all();
}

Eigen::Vector3d nothing(const Eigen::Matrix3d& /*R_stator_rotor*/) {
  return Eigen::Vector3d::Zero();
}

TEST(SessionSimulator, TruthExplainsNoiselessOrientationsExactly) {
  const Scene scene = exactScene();
  const Recording recording = scene.record();
  const JointGeometry joints = jointGeometry(scene.truth.joints);
  SessionTrajectory trajectory = scene.trajectory();
  for (const MarkerPoseMeasurement& pose : recording.poses) {
    const Eigen::Vector3d q = trajectory.at(scene.secondsInto(pose.stamp)).joint_position;
    ASSERT_LT((orientationOf(scene, pose) - rotorOrientation(joints, q)).norm(), 1e-13);
  }
  const JointGeometry nominal = jointGeometry(scenarios::paperNominal().joints);
  const Eigen::Vector3d last = scene.plan.dwells.back().joint_position;
  EXPECT_GT((orientationOf(scene, recording.poses.back()) - rotorOrientation(nominal, last)).norm(),
            1e-3);
}

TEST(SessionSimulator, TruthExplainsNoiselessTorquesExactly) {
  EXPECT_LT(largestTorqueResidual(exactScene(), nothing), 1e-12);
}

TEST(SessionSimulator, NoiselessJointsAndCurrentsAreThoseOfTheTrajectory) {
  const Scene scene = exactScene();
  const Recording recording = scene.record();
  SessionTrajectory joints = scene.trajectory();
  for (const JointMeasurement& joint : recording.joints) {
    ASSERT_EQ(joint.position, joints.at(scene.secondsInto(joint.stamp)).joint_position);
  }
  SessionTrajectory currents = scene.trajectory();
  for (const CurrentMeasurement& current : recording.currents) {
    ASSERT_EQ(current.current, currents.at(scene.secondsInto(current.stamp)).current);
  }
}

TEST(SessionSimulator, DeliversAtTheRatesInTheOrderOfStamps) {
  const Scene scene;
  const Recording recording = scene.record();
  const double duration = scene.trajectory().duration();
  EXPECT_NEAR(static_cast<double>(recording.joints.size()), 200.0 * duration, 2.0);
  EXPECT_NEAR(static_cast<double>(recording.poses.size()), 120.0 * duration, 2.0);
  EXPECT_NEAR(static_cast<double>(recording.wrenches.size()), 500.0 * duration, 2.0);
  EXPECT_NEAR(static_cast<double>(recording.currents.size()), 200.0 * duration, 2.0);
  EXPECT_TRUE(std::is_sorted(recording.order.begin(), recording.order.end()));
  EXPECT_GE(recording.order.front(), scene.options.begin);
}

TEST(SessionSimulator, SameSeedGivesTheSameMeasurements) {
  Scene scene;
  scene.options.tracker.stream.jitter = 0.002;
  scene.options.tracker.stream.glitches = 2;
  scene.options.wrench_sensor.stream.nan_share = 0.01;
  const Recording first = scene.record();
  const Recording second = scene.record();
  ASSERT_EQ(first.order, second.order);
  for (std::size_t n = 0; n < first.joints.size(); ++n) {
    ASSERT_EQ(first.joints[n].position, second.joints[n].position);
  }
  for (std::size_t n = 0; n < first.poses.size(); ++n) {
    ASSERT_EQ(first.poses[n].q_tracker_marker.coeffs(), second.poses[n].q_tracker_marker.coeffs());
  }
  for (std::size_t n = 0; n < first.wrenches.size(); ++n) {
    ASSERT_TRUE(same(first.wrenches[n].torque, second.wrenches[n].torque));
  }
  for (std::size_t n = 0; n < first.currents.size(); ++n) {
    ASSERT_EQ(first.currents[n].current, second.currents[n].current);
  }
  scene.options.seed = 2;
  EXPECT_NE(first.poses[0].q_tracker_marker.coeffs(),
            scene.record().poses[0].q_tracker_marker.coeffs());
}

TEST(SessionSimulator, NoiseHasTheStatedSize) {
  Scene scene;
  const Recording recording = scene.record();
  SessionTrajectory trajectory = scene.trajectory();
  const JointGeometry joints = jointGeometry(scene.truth.joints);
  double sum = 0.0;
  double largest = 0.0;
  for (const MarkerPoseMeasurement& pose : recording.poses) {
    const Eigen::Vector3d q = trajectory.at(scene.secondsInto(pose.stamp)).joint_position;
    const Eigen::Vector3d error =
        rotationLog(orientationOf(scene, pose) * rotorOrientation(joints, q).transpose());
    sum += error.squaredNorm();
    largest = std::max(largest, error.cwiseAbs().maxCoeff());
  }
  const double count = 3.0 * static_cast<double>(recording.poses.size());
  EXPECT_NEAR(std::sqrt(sum / count), 1e-3 / std::sqrt(3.0), 2e-5);
  EXPECT_LE(largest, 1.001e-3);
  SessionTrajectory joint_course = scene.trajectory();
  double joint_sum = 0.0;
  for (const JointMeasurement& joint : recording.joints) {
    joint_sum += (joint.position - joint_course.at(scene.secondsInto(joint.stamp)).joint_position)
                     .squaredNorm();
  }
  const double quantisation = 2.0 * kPi / 131072.0;
  EXPECT_NEAR(std::sqrt(joint_sum / (3.0 * static_cast<double>(recording.joints.size()))),
              std::sqrt(4e-10 + quantisation * quantisation / 12.0),
              1e-6);
}

TEST(SessionSimulator, JointReadingsAreQuantised) {
  const Scene scene;
  const double step = scene.options.joint_sensor.quantisation;
  for (const JointMeasurement& joint : scene.record().joints) {
    const Eigen::Vector3d steps = joint.position / step;
    ASSERT_LT((steps - steps.array().round().matrix()).norm(), 1e-9);
  }
}

TEST(SessionSimulator, SensorBiasAddsToTheWrench) {
  Scene scene = exactScene();
  scene.options.wrench_sensor.torque_bias = Eigen::Vector3d(0.0, 2.7e-3, 0.0);
  scene.options.wrench_sensor.force_bias = Eigen::Vector3d(0.1, 0.0, 0.0);
  const Eigen::Isometry3d& X = scene.options.registration.X_rotor_sensor;
  const Eigen::Vector3d force_bias = X.linear() * scene.options.wrench_sensor.force_bias;
  const Eigen::Vector3d bias = X.linear() * scene.options.wrench_sensor.torque_bias +
                               Eigen::Vector3d(X.translation()).cross(force_bias);
  EXPECT_GT(bias.norm(), 5e-3);
  EXPECT_LT(
      largestTorqueResidual(scene, [&](const Eigen::Matrix3d&) { return Eigen::Vector3d(bias); }),
      1e-12);
}

TEST(SessionSimulator, UnbalanceActsAsTheWeightOfTheRotor) {
  Scene scene = exactScene();
  scene.options.load.unbalance = Eigen::Vector3d(5.5e-3, 0.0, 1e-3);
  const Eigen::Vector3d unbalance = scene.options.load.unbalance;
  EXPECT_GT(largestTorqueResidual(scene, nothing), 4e-3);
  EXPECT_LT(largestTorqueResidual(scene,
                                  [&](const Eigen::Matrix3d& R) -> Eigen::Vector3d {
                                    const Eigen::Vector3d down(0.0, 0.0, -1.0);
                                    return unbalance.cross(R.transpose() * down);
                                  }),
            1e-12);
}

TEST(SessionSimulator, WeightGivesTheLeverArmItsMeaning) {
  const Scene scene = exactScene();
  double largest_lever_torque = 0.0;
  for (const WrenchMeasurement& wrench : scene.record().wrenches) {
    EXPECT_NEAR(wrench.force.norm(), 8.0, 1e-12);
    const Eigen::Vector3d rotated =
        scene.options.registration.X_rotor_sensor.linear() * wrench.torque;
    const Eigen::Vector3d torque = torqueFromWrench(scene.options.registration, wrench).torque;
    largest_lever_torque = std::max(largest_lever_torque, (torque - rotated).norm());
  }
  EXPECT_GT(largest_lever_torque, 0.05);
}

TEST(SessionSimulator, WithoutTorqueModelThereAreNeitherWrenchesNorCurrents) {
  Scene scene;
  scene.truth.poles.clear();
  scene.truth.coils.clear();
  scene.truth.torque_curve.reset();
  scene.plan = planSession(scene.truth, {}, 1);
  const Recording recording = scene.record();
  EXPECT_FALSE(recording.joints.empty());
  EXPECT_FALSE(recording.poses.empty());
  EXPECT_TRUE(recording.wrenches.empty());
  EXPECT_TRUE(recording.currents.empty());
}

/// Builds samples as the live system does.
class SampleSink : public MeasurementSink {
 public:
  SampleSink(const Registration& registration, std::size_t coils)
      : registration_(registration), builder_({}, coils) {}

  void add(const JointMeasurement& measurement) override { builder_.add(measurement); }
  void add(const MarkerPoseMeasurement& measurement) override {
    builder_.add(orientationFromMarkerPose(registration_, measurement));
  }
  void add(const WrenchMeasurement& measurement) override {
    builder_.add(torqueFromWrench(registration_, measurement));
  }
  void add(const CurrentMeasurement& measurement) override { builder_.add(measurement); }

  std::vector<Sample> finish() {
    builder_.finish();
    return builder_.takeSamples();
  }

 private:
  Registration registration_;
  SampleBuilder builder_;
};

TEST(SessionSimulator, EveryPatternOfThePlanGivesASample) {
  const Scene scene;
  SampleSink sink(scene.options.registration, scene.truth.coils.size());
  simulateSession(scene.truth, scene.plan, scene.options, sink);
  const std::vector<Sample> samples = sink.finish();
  std::size_t patterns = 0;
  for (const PlannedDwell& dwell : scene.plan.dwells) {
    patterns += dwell.patterns.size();
  }
  const auto excited = std::count_if(samples.begin(), samples.end(), [](const Sample& sample) {
    return sample.has_torque && sample.current.cwiseAbs().maxCoeff() > 1.9;
  });
  EXPECT_EQ(static_cast<std::size_t>(excited), patterns);
  EXPECT_EQ(samples.size(), scene.plan.dwells.size() + patterns);
  const TorqueCurve curve(*scene.truth.torque_curve);
  const TorqueGeometry geometry = torqueGeometry(scene.truth);
  const JointGeometry joints = jointGeometry(scene.truth.joints);
  for (const Sample& sample : samples) {
    const Eigen::Matrix3d R = rotorOrientation(joints, sample.joint_position);
    EXPECT_LT(rotationLog(sample.R_stator_rotor * R.transpose()).norm(), 4e-4);
    if (sample.has_torque) {
      const Eigen::Vector3d torque = rotorTorque(curve, geometry, R, sample.current);
      EXPECT_LT((sample.torque - torque).norm(), 6.0 * sample.torque_stddev);
    }
  }
}

TEST(SessionSimulator, TellsTheShareDone) {
  const Scene scene;
  Recording recording;
  Recorder recorder(recording);
  std::vector<double> shares;
  simulateSession(scene.truth, scene.plan, scene.options, recorder, [&](double share) {
    shares.push_back(share);
  });
  EXPECT_GT(shares.size(), 5U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
}

TEST(SessionSimulator, RefusesOptionsThatCannotBe) {
  const auto refused = [](void (*change)(SimulationOptions&)) {
    Scene scene;
    change(scene.options);
    EXPECT_THROW(scene.record(), ConfigError);
  };
  refused([](SimulationOptions& options) { options.joint_sensor.noise = -1.0; });
  refused([](SimulationOptions& options) { options.tracker.orientation_noise = NAN; });
  refused([](SimulationOptions& options) { options.wrench_sensor.stream.rate = 0.0; });
  refused([](SimulationOptions& options) { options.current_sensor.quantisation = -1.0; });
  refused([](SimulationOptions& options) { options.load.unbalance[1] = NAN; });
  refused([](SimulationOptions& options) { options.timing.move = 0.0; });
  Scene scene;
  scene.truth.coils.pop_back();
  EXPECT_THROW(scene.record(), ConfigError);
}

}  // namespace
}  // namespace sac
