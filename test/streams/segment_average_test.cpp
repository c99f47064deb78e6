#include "segment_average.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/SVD>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/synthetic_streams.hpp"

namespace sac {
namespace {

using synthetic::Script;
using synthetic::Sensors;
using synthetic::stampAt;
using synthetic::Streams;

const StampInterval whole_second{stampAt(0.0), stampAt(1.0)};

MeasurementBuffers buffersOf(const Streams& streams) {
  MeasurementBuffers buffers(0);
  for (const JointMeasurement& joint : streams.joints) {
    buffers.joints.push(joint.stamp, joint.position.data());
  }
  for (const OrientationMeasurement& orientation : streams.orientations) {
    buffers.orientations.push(orientation.stamp, orientation.q_stator_rotor.coeffs().data());
  }
  for (const TorqueMeasurement& torque : streams.torques) {
    buffers.torques.push(torque.stamp, torque.torque.data());
  }
  return buffers;
}

/// One second at rest.
Streams restingStreams(const Sensors& sensors = {}) {
  Script script(0);
  script.moveTo(Eigen::Vector3d(0.4, -0.3, 2.9), 1e-9).rest(1.0);
  return synthetic::record(script, sensors, 11);
}

std::string refusalOf(const Streams& streams, const StampInterval& interval = whole_second) {
  return averageSegment(buffersOf(streams), interval, {}).refusal;
}

/// The rotation nearest to the sum: for little scatter, the mean.
Eigen::Matrix3d meanOf(const std::vector<Eigen::Matrix3d>& rotations) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& R : rotations) {
    sum += R;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

TEST(SegmentAverage, AveragesOrientationsAsRotations) {
  Streams streams = restingStreams();
  // q and −q are the same orientation.
  for (std::size_t i = 0; i < streams.orientations.size(); i += 3) {
    streams.orientations[i].q_stator_rotor.coeffs() *= -1.0;
  }
  std::vector<Eigen::Matrix3d> rotations;
  for (const OrientationMeasurement& orientation : streams.orientations) {
    rotations.push_back(orientation.q_stator_rotor.toRotationMatrix());
  }
  const SegmentAverage average = averageSegment(buffersOf(streams), whole_second, {});
  ASSERT_TRUE(average.sample);
  EXPECT_TRUE(average.sample->has_orientation);
  const Eigen::Matrix3d difference = average.sample->R_stator_rotor * meanOf(rotations).transpose();
  EXPECT_LT(rotationLog(difference).norm(), 1e-9);
}

TEST(SegmentAverage, StatesWhatItIsMadeOf) {
  const Streams streams = restingStreams();
  const SegmentAverage average = averageSegment(buffersOf(streams), whole_second, {});
  ASSERT_TRUE(average.sample);
  EXPECT_EQ(average.sample->stamp, stampAt(0.5));
  EXPECT_DOUBLE_EQ(average.sample->duration, 1.0);
  EXPECT_EQ(average.sample->measurements, streams.orientations.size());
  EXPECT_EQ(average.torque_count, streams.torques.size());
  EXPECT_TRUE(average.notes.empty());
  EXPECT_NEAR(average.sample->torque_stddev, 2e-3 / std::sqrt(500.0), 2e-5);
}

TEST(SegmentAverage, NoUncertaintyIsBelowItsFloor) {
  Sensors sensors;
  sensors.joint_noise = 0.0;
  sensors.orientation_noise = 0.0;
  sensors.torque_noise = 0.0;
  const SegmentAverage average =
      averageSegment(buffersOf(restingStreams(sensors)), whole_second, {});
  ASSERT_TRUE(average.sample);
  const SampleBuilderOptions options;
  EXPECT_NEAR(average.sample->joint_stddev.y(), options.joint_stddev_floor, 1e-12);
  EXPECT_NEAR(average.sample->orientation_stddev, options.orientation_stddev_floor, 1e-12);
  EXPECT_NEAR(average.sample->torque_stddev, options.torque_stddev_floor, 1e-12);
}

TEST(SegmentAverage, StepsOfTheReadingsAreAnErrorThatTheDwellShares) {
  Sensors sensors;
  sensors.joint_noise = 0.0;
  MeasurementBuffers buffers = buffersOf(restingStreams(sensors));
  buffers.joint_step = Eigen::Vector3d(0.0, 1.2e-3, 0.0);
  const SegmentAverage average = averageSegment(buffers, whole_second, {});
  ASSERT_TRUE(average.sample);
  const double of_steps = 1.2e-3 / std::sqrt(12.0);
  EXPECT_NEAR(average.sample->joint_shared_stddev.y(), of_steps, 0.002 * of_steps);
  EXPECT_EQ(average.sample->joint_shared_stddev.x(), 0.0);
  EXPECT_GE(average.sample->joint_stddev.y(), average.sample->joint_shared_stddev.y());
}

TEST(SegmentAverage, LeavesGlitchesOut) {
  Streams streams = restingStreams();
  const SegmentAverage clean = averageSegment(buffersOf(streams), whole_second, {});
  streams.joints[50].position.x() += 0.5;
  // Half a turn, at the very place where the reference is looked for.
  Eigen::Quaterniond& q = streams.orientations[streams.orientations.size() / 2].q_stator_rotor;
  q = q * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  streams.torques[70].torque.z() = 50.0;
  const SegmentAverage average = averageSegment(buffersOf(streams), whole_second, {});
  ASSERT_TRUE(average.sample);
  EXPECT_EQ(average.joint_glitches, 1U);
  EXPECT_EQ(average.orientation_glitches, 1U);
  EXPECT_EQ(average.torque_glitches, 1U);
  EXPECT_LT((average.sample->joint_position - clean.sample->joint_position).norm(), 2e-6);
  EXPECT_LT((average.sample->R_stator_rotor - clean.sample->R_stator_rotor).norm(), 2e-5);
  EXPECT_LT((average.sample->torque - clean.sample->torque).norm(), 2e-5);
}

TEST(SegmentAverage, RefusesAShortInterval) {
  EXPECT_EQ(refusalOf(restingStreams(), {stampAt(0.3), stampAt(0.45)}),
            "It lasts only 0.15 s; 0.2 s are needed.");
  EXPECT_EQ(refusalOf(restingStreams(), {stampAt(0.5), stampAt(0.4)}),
            "It lasts only 0 s; 0.2 s are needed.");
}

TEST(SegmentAverage, RefusesTooFewJointMeasurements) {
  Streams streams = restingStreams();
  streams.joints.resize(4);
  EXPECT_EQ(refusalOf(streams), "It has only 4 joint measurements.");
}

TEST(SegmentAverage, RefusesADriftingJoint) {
  Streams streams = restingStreams();
  for (JointMeasurement& joint : streams.joints) {
    joint.position.y() += 1e-3 * synthetic::timeOf(joint.stamp);
  }
  EXPECT_EQ(refusalOf(streams).substr(0, 21), "joint_2 drifted by 0.");
}

TEST(SegmentAverage, RefusesATremblingJoint) {
  Streams streams = restingStreams();
  for (JointMeasurement& joint : streams.joints) {
    joint.position.z() += 2e-3 * std::sin(200.0 * synthetic::timeOf(joint.stamp));
  }
  EXPECT_EQ(refusalOf(streams).substr(0, 24), "joint_3 was not at rest:");
}

TEST(SegmentAverage, RefusesWhatTheTrackerSawMove) {
  Streams streams = restingStreams();
  for (OrientationMeasurement& orientation : streams.orientations) {
    const double angle = 0.02 * synthetic::timeOf(orientation.stamp);
    orientation.q_stator_rotor =
        Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY())) *
        orientation.q_stator_rotor;
  }
  EXPECT_EQ(refusalOf(streams).substr(0, 34), "The measured orientation moved by ");
}

TEST(SegmentAverage, RefusesWhatTheTrackerSawSway) {
  Streams streams = restingStreams();
  for (OrientationMeasurement& orientation : streams.orientations) {
    const double angle = 0.02 * std::sin(20.0 * synthetic::timeOf(orientation.stamp));
    orientation.q_stator_rotor =
        Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY())) *
        orientation.q_stator_rotor;
  }
  EXPECT_EQ(refusalOf(streams).substr(0, 34), "The measured orientation sways by ");
}

TEST(SegmentAverage, TakesTheNoiseOfATrackerForNoMotion) {
  Sensors sensors;
  sensors.orientation_noise = 0.01;
  const SegmentAverage average =
      averageSegment(buffersOf(restingStreams(sensors)), whole_second, {});
  ASSERT_TRUE(average.sample.has_value()) << average.refusal;
  EXPECT_TRUE(average.sample->has_orientation);
  EXPECT_GT(average.sample->orientation_stddev, 5e-4);
}

TEST(SegmentAverage, RefusesAScatteringTracker) {
  Sensors sensors;
  sensors.orientation_noise = 0.2;
  EXPECT_EQ(refusalOf(restingStreams(sensors)).substr(0, 37),
            "The measured orientation scatters by ");
}

TEST(SegmentAverage, RefusesJointsAlone) {
  Streams streams = restingStreams();
  streams.orientations.clear();
  streams.torques.clear();
  EXPECT_EQ(refusalOf(streams), "It has neither orientation nor torque.");
}

TEST(SegmentAverage, TellsOfAHoleAndOfTooFew) {
  Streams streams = restingStreams();
  streams.orientations.erase(streams.orientations.begin() + 30, streams.orientations.begin() + 80);
  streams.torques.resize(5);
  const SegmentAverage average = averageSegment(buffersOf(streams), whole_second, {});
  ASSERT_TRUE(average.sample);
  EXPECT_TRUE(average.sample->has_orientation);
  EXPECT_FALSE(average.sample->has_torque);
  ASSERT_EQ(average.notes.size(), 2U);
  EXPECT_EQ(average.notes[0].substr(0, 40), "The measured orientation has a hole of 0");
  EXPECT_EQ(average.notes[1], "It has no torque: only 5 measurements of it.");
}

}  // namespace
}  // namespace sac
