#include "spherical_actuator_calibration/motion/motion_memory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "motion/streamed_coils.hpp"

namespace sac {
namespace {

constexpr double kRememberedRate = 100.0;  // [Hz]

class MotionMemoryTest : public ::testing::Test {
 protected:
  /// So many seconds with a turning rotor or a resting one, with or without currents.
  void pass(double seconds, bool moves, bool is_driven) {
    for (int n = 0; n < static_cast<int>(seconds * kRememberedRate); ++n) {
      now_ += 1.0 / kRememberedRate;
      spin_ += moves ? 0.5 / kRememberedRate : 0.0;
      const auto stamp = static_cast<Stamp>(std::llround(now_ * 1e9));
      memory_.add(JointMeasurement{stamp, Eigen::Vector3d(0.1, 0.0, spin_)});
      memory_.add(CurrentMeasurement{stamp, Eigen::Vector2d::Constant(is_driven ? 0.5 : 0.0)});
      memory_.add(OrientationMeasurement{stamp, Eigen::Quaterniond::Identity()});
    }
  }
  static double secondsOf(const MotionRecording& recording) {
    double seconds = 0.0;
    for (const MotionStreams& streams : recording.spans) {
      seconds += static_cast<double>(streams.joints.size()) / kRememberedRate;
    }
    return seconds;
  }

  double now_ = 1000.0;
  double spin_ = 0.0;
  MotionMemory memory_{kCoils, 1'000'000};
};

TEST_F(MotionMemoryTest, KeepsWhatMovedWithCurrents) {
  pass(5.0, true, true);
  const MotionRecording recording = memory_.recording();
  ASSERT_EQ(recording.spans.size(), 1U);
  EXPECT_EQ(recording.spans[0].currents.rows(), 500);
  EXPECT_EQ(recording.spans[0].orientations.size(), 500U);
  EXPECT_EQ(memory_.recording().spans.size(), 1U);  // to ask does not take it away
  memory_.forget();
  EXPECT_TRUE(memory_.recording().empty());
}

TEST_F(MotionMemoryTest, TakesUpTheWindowsOfAnEarlierOne) {
  MotionSlicer slicer(kCoils, MotionOptions());
  pass(5.0, true, true);
  const MotionStreams before = memory_.recording().spans.at(0);
  std::vector<MotionSlice> windows;
  for (std::size_t n = 0; n < before.joints.size(); ++n) {
    const Stamp stamp = before.joint_stamps[n];
    slicer.add(CurrentMeasurement{stamp, Eigen::Vector2d::Constant(0.5)});
    slicer.add(OrientationMeasurement{stamp, before.orientations[n]});
    slicer.add(JointMeasurement{stamp, before.joints[n]});
    while (auto window = slicer.take()) {
      windows.push_back(std::move(*window));
    }
  }
  ASSERT_GT(windows.size(), 15U);
  MotionMemory later(kCoils, 1'000'000);
  later.restore(windows);
  const MotionRecording recording = later.recording();
  ASSERT_EQ(recording.spans.size(), 1U);
  const MotionStreams& after = recording.spans[0];
  // What windows have beside them: some readings at both ends are lost.
  EXPECT_GT(after.joints.size(), before.joints.size() - 60U);
  const auto first =
      std::find(before.joint_stamps.begin(), before.joint_stamps.end(), after.joint_stamps.front());
  const auto offset = static_cast<std::size_t>(first - before.joint_stamps.begin());
  for (std::size_t n = 0; n < after.joints.size(); ++n) {
    ASSERT_EQ(after.joint_stamps[n], before.joint_stamps[offset + n]);
    ASSERT_EQ(after.joints[n], before.joints[offset + n]);
  }
  EXPECT_GE(after.current_stamps.size() + 1U, after.joints.size());
  EXPECT_GE(after.orientations.size() + 20U, after.joints.size());
  EXPECT_EQ(recording.dropped, 0U);
}

TEST_F(MotionMemoryTest, KeepsNeitherDwellsNorAFixtureThatTurnsTheRotor) {
  pass(40.0, false, true);
  pass(40.0, true, false);
  EXPECT_TRUE(memory_.recording().empty());
}

TEST_F(MotionMemoryTest, KeepsAShortMotionBetweenLongRests) {
  pass(20.0, false, false);
  pass(6.0, true, true);
  pass(40.0, false, false);
  const MotionRecording recording = memory_.recording();
  EXPECT_GE(secondsOf(recording), 6.0);
  EXPECT_LE(secondsOf(recording), 61.0);
}

TEST_F(MotionMemoryTest, ForgetsTheOldestFirst) {
  pass(300.0, true, true);
  const MotionRecording recording = memory_.recording();
  // A hundredth of a second takes 96 bytes: a million of them are 104 s.
  EXPECT_LE(secondsOf(recording), 105.0);
  EXPECT_GE(secondsOf(recording), 60.0);
  const double last = 1e-9 * static_cast<double>(recording.spans.back().joint_stamps.back());
  EXPECT_NEAR(last, now_, 0.02);
}

// Memory is what it is about; what came before the flood is kept.
TEST_F(MotionMemoryTest, HoldsOutAgainstAFloodOfOneStream) {
  pass(10.0, true, true);
  for (Stamp n = 1; n < 1'000'000; ++n) {
    memory_.add(CurrentMeasurement{2'000'000'000'000 + n, Eigen::Vector2d::Ones()});
  }
  pass(10.0, true, true);
  const MotionRecording recording = memory_.recording();
  std::size_t currents = 0;
  for (const MotionStreams& streams : recording.spans) {
    currents += streams.current_stamps.size();
  }
  EXPECT_LE(currents, 1'000'000U / 16U);
  EXPECT_GE(secondsOf(recording), 10.0);
}

TEST_F(MotionMemoryTest, BeginsAnewWhereTheClockIsSetBack) {
  pass(5.0, true, true);
  now_ -= 100.0;
  pass(5.0, true, true);
  const MotionRecording recording = memory_.recording();
  ASSERT_EQ(recording.spans.size(), 2U);
  EXPECT_NEAR(secondsOf(recording), 10.0, 0.05);
}

}  // namespace
}  // namespace sac
