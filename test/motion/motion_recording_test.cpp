#include "spherical_actuator_calibration/motion/motion_recording.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/resident_memory.hpp"

namespace sac {
namespace {

JointMeasurement joints(Stamp stamp, double spin) {
  return {stamp, Eigen::Vector3d(0.1, 0.2, spin)};
}

CurrentMeasurement currents(Stamp stamp) {
  return {stamp, Eigen::Vector2d(0.5, -0.25)};
}

TEST(MotionRecorder, TakesLittleMemoryForLongStreams) {
  constexpr int kReadings = 400'000;  // of 24 coils, 40 MB, and of joints, 10 MB
  const Eigen::VectorXd current = Eigen::VectorXd::LinSpaced(24, 0.0, 1.0);
  MotionRecording recording;
  const double bytes = peakBeside([&] {
    MotionRecorder recorder(24);
    for (int n = 0; n < kReadings; ++n) {
      const Stamp stamp = 1'000'000LL * n;
      recorder.add(joints(stamp, 1e-6 * n));
      recorder.add(CurrentMeasurement{stamp, current});
    }
    recording = recorder.take();
  });
  EXPECT_LT(bytes, 35e6);
  ASSERT_EQ(recording.spans.size(), 1U);
  const MotionStreams& streams = recording.spans[0];
  EXPECT_EQ(streams.joints[kReadings - 1][2], 1e-6 * (kReadings - 1));
  EXPECT_EQ(streams.currents.rows(), kReadings);
  EXPECT_EQ(streams.currents(kReadings / 2, 23), 1.0F);
}

TEST(MotionRecorder, TakesNoJumpOfASensorThatWrapsAround) {
  MotionRecorder recorder(2);
  recorder.add(joints(1, 3.1));
  recorder.add(joints(2, -3.1));
  recorder.add(joints(3, -3.0));
  recorder.add(currents(1));
  const MotionRecording recording = recorder.take();
  ASSERT_EQ(recording.spans.size(), 1U);
  EXPECT_NEAR(recording.spans[0].joints[1][2], 2.0 * kPi - 3.1, 1e-12);
  EXPECT_NEAR(recording.spans[0].joints[2][2], 2.0 * kPi - 3.0, 1e-12);
}

TEST(MotionRecorder, DropsWhatIsOutOfOrderOrNotANumber) {
  MotionRecorder recorder(2);
  recorder.add(joints(5, 0.0));
  recorder.add(joints(5, 0.1));
  recorder.add(joints(4, 0.1));
  recorder.add(joints(6, std::numeric_limits<double>::quiet_NaN()));
  recorder.add(currents(7));
  recorder.add(CurrentMeasurement{8, Eigen::VectorXd::Zero(3)});
  recorder.add(OrientationMeasurement{9, Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0)});
  const MotionRecording recording = recorder.take();
  EXPECT_EQ(recording.dropped, 5U);
  ASSERT_EQ(recording.spans.size(), 1U);
  EXPECT_EQ(recording.spans[0].joints.size(), 1U);
  EXPECT_FLOAT_EQ(recording.spans[0].currents(0, 1), -0.25F);
}

TEST(MotionRecorder, KeepsSpansApart) {
  MotionRecorder recorder(2);
  for (int span = 0; span < 2; ++span) {
    recorder.add(joints(1, 0.0));
    recorder.add(currents(1));
    recorder.finish();
  }
  recorder.add(joints(1, 0.0));  // without currents it tells no motion
  EXPECT_EQ(recorder.take().spans.size(), 2U);
}

TEST(MotionRecorder, BeginsAnotherSpanWhereTheClockIsSetBack) {
  MotionRecorder recorder(2);
  constexpr Stamp kSecond = 1'000'000'000;
  for (const Stamp begin : {100 * kSecond, 50 * kSecond}) {
    for (Stamp n = 0; n < 1000; ++n) {
      recorder.add(currents(begin + 1'000'000 * n));
      recorder.add(joints(begin + 1'000'000 * n, 0.0));
    }
  }
  const MotionRecording recording = recorder.take();
  ASSERT_EQ(recording.spans.size(), 2U);
  EXPECT_EQ(recording.spans[0].joints.size(), 1000U);
  // The first one of each stream looks like a single wrong stamp.
  EXPECT_GE(recording.spans[1].joints.size(), 998U);
  EXPECT_GE(recording.spans[1].current_stamps.size(), 998U);
}

TEST(MotionRecorder, BeginsAnotherSpanWhereNothingCameForLong) {
  constexpr Stamp kSecond = 1'000'000'000;
  const auto spans = [](Stamp pause, bool tracker_goes_on) {
    MotionRecorder recorder(2);
    for (const Stamp begin : {100 * kSecond, 101 * kSecond + pause}) {
      for (Stamp n = 0; n <= 1000; ++n) {
        recorder.add(joints(begin + 1'000'000 * n, 0.0));
        recorder.add(currents(begin + 1'000'000 * n));
      }
      if (tracker_goes_on) {
        recorder.add(OrientationMeasurement{begin + 2 * kSecond, Eigen::Quaterniond::Identity()});
      }
    }
    const MotionRecording recording = recorder.take();
    EXPECT_EQ(recording.dropped, 0U);
    std::size_t readings = 0;
    for (const MotionStreams& streams : recording.spans) {
      EXPECT_EQ(streams.joints.size(), streams.current_stamps.size());
      readings += streams.joints.size();
    }
    EXPECT_EQ(readings, 2002U);
    return recording.spans.size();
  };
  EXPECT_EQ(spans(6 * kSecond, false), 2U);
  EXPECT_EQ(spans(4 * kSecond, false), 1U);
  EXPECT_EQ(spans(6 * kSecond - 1, true), 1U);
}

// The tracker, say, which was not there before.
TEST(MotionRecorder, BeginsAnotherSpanWithAStreamThatIsNew) {
  constexpr Stamp kSecond = 1'000'000'000;
  MotionRecorder recorder(2);
  recorder.add(joints(kSecond, 0.0));
  recorder.add(currents(kSecond));
  recorder.add(OrientationMeasurement{9 * kSecond, Eigen::Quaterniond::Identity()});
  recorder.add(joints(9 * kSecond + 1, 0.0));
  recorder.add(currents(9 * kSecond + 1));
  const MotionRecording recording = recorder.take();
  ASSERT_EQ(recording.spans.size(), 2U);
  EXPECT_TRUE(recording.spans[0].orientations.empty());
  EXPECT_EQ(recording.spans[1].orientations.size(), 1U);
}

TEST(MotionRecorder, LosesLittleByASingleWrongStamp) {
  constexpr Stamp kSecond = 1'000'000'000;
  for (const Stamp jump : {100 * kSecond, -20 * kSecond}) {
    MotionRecorder recorder(2);
    for (Stamp n = 0; n < 1000; ++n) {
      const Stamp stamp = 50 * kSecond + 1'000'000 * n;
      recorder.add(currents(stamp));
      recorder.add(joints(stamp + (n == 500 ? jump : 0), 0.0));
    }
    std::size_t kept = 0;
    for (const MotionStreams& streams : recorder.take().spans) {
      kept += streams.joints.size();
    }
    EXPECT_GE(kept, 997U) << jump;
  }
}

TEST(MotionRecorder, TellsMotionFromDwells) {
  MotionRecorder moving(2);
  MotionRecorder resting(2);
  MotionRecorder pushed_by_hand(2);
  for (int n = 0; n < 1000; ++n) {
    const Stamp stamp = 1'000'000LL * n;
    moving.add(joints(stamp, 1e-3 * n));
    moving.add(currents(stamp));
    resting.add(joints(stamp, n < 700 ? 0.0 : 1e-3 * n));
    resting.add(currents(stamp));
    pushed_by_hand.add(joints(stamp, 1e-3 * n));
    pushed_by_hand.add(CurrentMeasurement{stamp, Eigen::Vector2d::Zero()});
  }
  EXPECT_TRUE(tellsMotion(moving.take()));
  EXPECT_FALSE(tellsMotion(resting.take()));
  EXPECT_FALSE(tellsMotion(pushed_by_hand.take()));
  EXPECT_FALSE(tellsMotion(MotionRecording()));
}

}  // namespace
}  // namespace sac
