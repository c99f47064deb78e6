#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "streams/scripted_dwell.hpp"
#include "support/not_a_number.hpp"
#include "support/synthetic_streams.hpp"

#include <malloc.h>

/// What goes wrong in streams: nothing wrong enters, and what was dropped is counted.
namespace sac {
namespace {

using synthetic::samplesOf;
using synthetic::Script;
using synthetic::stampAt;
using synthetic::Streams;
using synthetic::timeOf;

constexpr std::size_t kDefectCoils = 2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// At rest from 0.8 s to 4.8 s, excited from 2.8 s on.
Streams oneDwell() {
  const Script script = Script(kDefectCoils)
                            .moveTo(rest_pose)
                            .rest(2.0)
                            .excite(0, 2.0, 2.0)
                            .moveTo(-rest_pose)
                            .rest(0.1);
  return synthetic::record(script, {}, 21);
}

/// The two samples of oneDwell(), as good as ever.
void expectUnharmed(const std::vector<Sample>& samples) {
  ASSERT_EQ(samples.size(), 2U);
  const Eigen::Vector3d torque = Script::torque(2.0 * Eigen::VectorXd::Unit(kDefectCoils, 0));
  EXPECT_LT((samples[1].torque - torque).norm(), 6e-4);
  for (const Sample& sample : samples) {
    EXPECT_LT((sample.joint_position - rest_pose).norm(), 3e-5);
    EXPECT_TRUE(sample.has_orientation);
    EXPECT_LT(
        rotationLog(sample.R_stator_rotor * Script::orientation(rest_pose).transpose()).norm(),
        2e-4);
  }
}

TEST(StreamDefects, NotFiniteNumbersAreDropped) {
  Streams streams = oneDwell();
  streams.joints[500].position.y() = kNaN;
  streams.joints[501].position.x() = kInfinity;
  streams.orientations[300].q_stator_rotor.w() = kNaN;
  streams.torques[1000].torque.z() = -kInfinity;
  streams.currents[400].current[1] = kNaN;
  SampleBuilder builder({}, kDefectCoils);
  expectUnharmed(samplesOf(builder, streams));
  EXPECT_EQ(builder.report().joints.droppedFor(DropReason::kNotFinite), 2U);
  EXPECT_EQ(builder.report().orientations.droppedFor(DropReason::kNotFinite), 1U);
  EXPECT_EQ(builder.report().torques.droppedFor(DropReason::kNotFinite), 1U);
  EXPECT_EQ(builder.report().currents.droppedFor(DropReason::kNotFinite), 1U);
  EXPECT_EQ(builder.report().joints.received, streams.joints.size());
  EXPECT_EQ(builder.report().joints.accepted, streams.joints.size() - 2);
}

TEST(StreamDefects, QuaternionsThatAreNotUnitAreDroppedOrNormalised) {
  Streams streams = oneDwell();
  streams.orientations[300].q_stator_rotor.coeffs() *= 1.002;
  streams.orientations[301].q_stator_rotor.coeffs().setZero();
  streams.orientations[302].q_stator_rotor.coeffs() *= 1e200;
  for (std::size_t i = 303; i < streams.orientations.size(); ++i) {
    streams.orientations[i].q_stator_rotor.coeffs() *= 1.0009;
  }
  SampleBuilder builder({}, kDefectCoils);
  const std::vector<Sample> samples = samplesOf(builder, streams);
  expectUnharmed(samples);
  EXPECT_EQ(builder.report().orientations.droppedFor(DropReason::kNotUnit), 3U);
  EXPECT_NO_THROW(validate(samples.at(1), kDefectCoils));
}

TEST(StreamDefects, CurrentsOfWrongSizeAreDropped) {
  Streams streams = oneDwell();
  streams.currents[400].current = Eigen::VectorXd::Constant(kDefectCoils + 1, 9.0);
  streams.currents[401].current.resize(0);
  SampleBuilder builder({}, kDefectCoils);
  expectUnharmed(samplesOf(builder, streams));
  EXPECT_EQ(builder.report().currents.droppedFor(DropReason::kWrongSize), 2U);
}

TEST(StreamDefects, RepeatedAndLateStampsAreDropped) {
  Streams streams = oneDwell();
  streams.joints[500].stamp = streams.joints[499].stamp;
  streams.joints[600].stamp -= ticksFromSeconds(0.3);
  streams.orientations[300].stamp = 0;
  streams.torques[1000].stamp = streams.torques[999].stamp;
  streams.torques[1001].stamp -= ticksFromSeconds(0.9);
  SampleBuilder builder({}, kDefectCoils);
  expectUnharmed(samplesOf(builder, streams));
  EXPECT_EQ(builder.report().joints.droppedFor(DropReason::kRepeated), 1U);
  EXPECT_EQ(builder.report().joints.droppedFor(DropReason::kLate), 1U);
  EXPECT_EQ(builder.report().orientations.droppedFor(DropReason::kUnstamped), 1U);
  EXPECT_EQ(builder.report().torques.droppedFor(DropReason::kRepeated), 1U);
  EXPECT_EQ(builder.report().torques.droppedFor(DropReason::kLate), 1U);
}

TEST(StreamDefects, OneWildStampCostsOneMeasurement) {
  for (const double error : {-1000.0, -2.0, 1000.0}) {
    Streams streams = oneDwell();
    streams.joints[500].stamp += ticksFromSeconds(error);
    streams.torques[1000].stamp += ticksFromSeconds(error);
    SampleBuilder builder({}, kDefectCoils);
    expectUnharmed(samplesOf(builder, streams));
    EXPECT_EQ(builder.report().joints.droppedFor(DropReason::kJump), 1U);
    EXPECT_EQ(builder.report().torques.droppedFor(DropReason::kJump), 1U);
    EXPECT_EQ(builder.report().joints.clock_resets, 0U);
  }
}

TEST(StreamDefects, GlitchesStayOutOfTheMeans) {
  Streams streams = oneDwell();
  streams.joints[500].position.x() += 1.0;
  streams.orientations[300].q_stator_rotor = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  streams.torques[2000].torque.y() = 30.0;
  streams.currents[800].current[1] = 3.0;
  SampleBuilder builder({}, kDefectCoils);
  const std::vector<Sample> samples = samplesOf(builder, streams);
  expectUnharmed(samples);
  EXPECT_NEAR(samples.at(1).current[1], 0.0, 1e-3);
  EXPECT_EQ(builder.report().joints.glitches, 1U);
  EXPECT_EQ(builder.report().orientations.glitches, 1U);
  EXPECT_EQ(builder.report().torques.glitches, 1U);
}

TEST(StreamDefects, ADropoutOfTheTrackerIsToldAndTheRestUsed) {
  Streams streams = oneDwell();
  // 1.5 s to 3.5 s.
  streams.orientations.erase(streams.orientations.begin() + 180,
                             streams.orientations.begin() + 420);
  SampleBuilder builder({}, kDefectCoils);
  expectUnharmed(samplesOf(builder, streams));
  EXPECT_EQ(builder.report().orientations.gaps, 1U);
  ASSERT_EQ(builder.report().events.size(), 2U);
  for (const DwellEvent& event : builder.report().events) {
    EXPECT_EQ(event.kind, DwellEvent::Kind::kNote);
    EXPECT_EQ(event.reason.substr(0, 39), "The measured orientation has a hole of ");
  }
}

TEST(StreamDefects, ADropoutOfTheTrackerLeavesTorqueSamples) {
  Streams streams = oneDwell();
  streams.orientations.erase(streams.orientations.begin() + 300, streams.orientations.end() - 5);
  SampleBuilder builder({}, kDefectCoils);
  const std::vector<Sample> samples = samplesOf(builder, streams);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_TRUE(samples[0].has_orientation);
  EXPECT_FALSE(samples[1].has_orientation);
  EXPECT_TRUE(samples[1].has_torque);
}

TEST(StreamDefects, ADropoutOfTheJointSensorsEndsTheDwell) {
  Streams streams = oneDwell();
  // 2.0 s to 2.5 s.
  streams.joints.erase(streams.joints.begin() + 400, streams.joints.begin() + 500);
  SampleBuilder builder({}, kDefectCoils);
  const std::vector<Sample> samples = samplesOf(builder, streams);
  EXPECT_EQ(builder.report().dwells, 2U);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_LT(timeOf(samples[0].stamp) + 0.5 * samples[0].duration, 2.0);
}

TEST(StreamDefects, ATrackerThatMovesAloneIsRefused) {
  Streams streams = oneDwell();
  for (OrientationMeasurement& orientation : streams.orientations) {
    const double angle = 0.03 * std::sin(timeOf(orientation.stamp));
    orientation.q_stator_rotor =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()) * orientation.q_stator_rotor;
  }
  SampleBuilder builder({}, kDefectCoils);
  EXPECT_TRUE(samplesOf(builder, streams).empty());
  EXPECT_EQ(builder.report().discarded, 2U);
  for (const DwellEvent& event : builder.report().events) {
    EXPECT_EQ(event.kind, DwellEvent::Kind::kDiscarded);
    EXPECT_NE(event.reason.find("while the joint sensors stood still"), std::string::npos);
  }
}

TEST(StreamDefects, AResetOfAllClocksSeparatesWhatWasBefore) {
  // The same times twice, the second time in another pose: old data would fit the new stamps.
  const Eigen::Vector3d other_pose(-0.1, 0.4, -0.7);
  const Script before = Script(kDefectCoils).moveTo(rest_pose).rest(6.0);
  const Script after = Script(kDefectCoils).moveTo(other_pose).rest(3.0).moveTo(rest_pose);
  const Streams old_streams = synthetic::record(before, {}, 1);
  const Streams new_streams = synthetic::record(after, {}, 2);
  SampleBuilder builder({}, kDefectCoils);
  synthetic::feed(builder, old_streams);
  synthetic::feed(builder, new_streams);
  builder.finish();
  const std::vector<Sample> samples = builder.takeSamples();
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_LT((samples[0].joint_position - rest_pose).norm(), 3e-5);
  EXPECT_LT((samples[1].joint_position - other_pose).norm(), 3e-5);
  for (const Sample& sample : samples) {
    const Eigen::Matrix3d R = Script::orientation(sample.joint_position);
    EXPECT_LT(rotationLog(sample.R_stator_rotor * R.transpose()).norm(), 2e-4);
  }
  EXPECT_GE(builder.report().joints.clock_resets, 1U);
  EXPECT_GE(builder.report().torques.clock_resets, 1U);
}

TEST(StreamDefects, AStreamWhoseClockIsBehindDoesNotMixIn) {
  // The joint sensors' clock jumps back by 3 s in another pose: what the others measured in the
  // first pose has the stamps that the joint sensors give now.
  const Eigen::Vector3d other_pose(-0.1, 0.4, -0.7);
  const Script script =
      Script(kDefectCoils).moveTo(rest_pose).rest(4.0).moveTo(other_pose).rest(6.0);
  Streams streams = synthetic::record(script, {}, 3);
  for (JointMeasurement& joint : streams.joints) {
    if (timeOf(joint.stamp) > 5.0) {
      joint.stamp -= ticksFromSeconds(3.0);
    }
  }
  // Fed in the order of the true times: streams of different clocks arrive together.
  SampleBuilder builder({}, kDefectCoils);
  std::size_t k = 0;
  for (std::size_t i = 0; i < streams.joints.size(); ++i) {
    builder.add(streams.joints[i]);
    const double time = static_cast<double>(i) / 200.0;
    for (; k < streams.orientations.size() && timeOf(streams.orientations[k].stamp) < time; ++k) {
      builder.add(streams.orientations[k]);
    }
  }
  builder.finish();
  for (const Sample& sample : builder.takeSamples()) {
    const Eigen::Matrix3d R = Script::orientation(sample.joint_position);
    EXPECT_LT(rotationLog(sample.R_stator_rotor * R.transpose()).norm(), 1e-3);
  }
  EXPECT_EQ(builder.report().joints.clock_resets, 1U);
  EXPECT_GT(builder.report().joints.droppedFor(DropReason::kBehind), 1000U);
}

TEST(StreamDefects, NoiseOfEveryKindCrashesNothing) {
  const double bad[] = {kNaN, kInfinity, 0.0, 1e300, -1.0};
  const Stamp stamps[] = {std::numeric_limits<Stamp>::min(),
                          -1,
                          0,
                          1,
                          stampAt(0.0),
                          stampAt(1.0),
                          std::numeric_limits<Stamp>::max()};
  SampleBuilder builder({}, kDefectCoils);
  std::uint64_t added = 0;
  for (int round = 0; round < 50; ++round) {
    for (const double value : bad) {
      for (const Stamp stamp : stamps) {
        builder.add(JointMeasurement{stamp, Eigen::Vector3d::Constant(value)});
        builder.add(OrientationMeasurement{stamp, Eigen::Quaterniond(value, value, value, value)});
        builder.add(TorqueMeasurement{stamp, Eigen::Vector3d::Constant(value)});
        builder.add(CurrentMeasurement{stamp, Eigen::VectorXd::Constant(round % 4, value)});
        ++added;
      }
    }
  }
  builder.finish();
  EXPECT_TRUE(builder.takeSamples().empty());
  const StreamStatistics& joints = builder.report().joints;
  EXPECT_EQ(joints.received, added);
  EXPECT_EQ(joints.accepted + joints.droppedInAll(), added);
}

std::size_t heapInUse() {
#if __GLIBC_PREREQ(2, 33)
  const auto info = mallinfo2();
#else
  const auto info = mallinfo();  // in int, enough below 2 GB
#endif
  return static_cast<std::size_t>(info.uordblks) + static_cast<std::size_t>(info.hblkhd);
}

/// Heap in use after each half of a long run of `tick`, which is called 200 times a second.
template <typename Tick>
std::pair<std::size_t, std::size_t> heapAfterHalves(SampleBuilder& builder, Tick tick) {
  constexpr int kTicks = 200 * 1200;
  std::pair<std::size_t, std::size_t> heap;
  for (int i = 0; i < 2 * kTicks; ++i) {
    tick(i, stampAt(0.005 * i));
    if (i % 10000 == 9999) {
      builder.takeSamples();
    }
    if (i == kTicks - 1) {
      heap.first = heapInUse();
    }
  }
  heap.second = heapInUse();
  return heap;
}

TEST(SampleBuilderMemory, IsBoundedWhateverTheStreamsDo) {
  const CurrentMeasurement current{0, Eigen::VectorXd::Zero(kDefectCoils)};
  const auto add_others = [&current](SampleBuilder& builder, Stamp stamp) {
    builder.add(OrientationMeasurement{stamp, Eigen::Quaterniond::Identity()});
    builder.add(TorqueMeasurement{stamp, Eigen::Vector3d::Zero()});
    CurrentMeasurement stamped = current;
    stamped.stamp = stamp;
    builder.add(stamped);
  };
  enum class Joints { kAtRest, kMoving, kNever, kSilentAfterAWhile, kAlone };
  for (const Joints joints : {Joints::kAtRest,
                              Joints::kMoving,
                              Joints::kNever,
                              Joints::kSilentAfterAWhile,
                              Joints::kAlone}) {
    SampleBuilderOptions options;
    options.largest_dwell = 20.0;
    SampleBuilder builder(options, kDefectCoils);
    const auto [half, whole] = heapAfterHalves(builder, [&](int i, Stamp stamp) {
      const bool joints_speak =
          joints != Joints::kNever && !(joints == Joints::kSilentAfterAWhile && i > 2000);
      if (joints_speak) {
        const double angle = joints == Joints::kMoving ? 1e-3 * i : 0.0;
        builder.add(JointMeasurement{stamp, Eigen::Vector3d::Constant(angle)});
      }
      if (joints != Joints::kAlone) {
        add_others(builder, stamp);
      }
    });
    // Another 20 minutes; only the told events may have grown.
    EXPECT_LT(whole, half + 50000) << static_cast<int>(joints);
  }
}

TEST(SampleBuilderMemory, EventsAreToldUpToABound) {
  SampleBuilderReport report;
  for (std::size_t i = 0; i < SampleBuilderReport::kMaxEvents + 5; ++i) {
    report.add({DwellEvent::Kind::kDiscarded, 1, "It moved."});
  }
  EXPECT_EQ(report.events.size(), SampleBuilderReport::kMaxEvents);
  EXPECT_EQ(report.events_untold, 5U);
  EXPECT_EQ(report.discarded, SampleBuilderReport::kMaxEvents + 5);
}

}  // namespace
}  // namespace sac
