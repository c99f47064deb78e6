#include "spherical_actuator_calibration/motion/motion_slice.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "motion/streamed_coils.hpp"
#include "motion_span.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

constexpr double kSlicedRate = 200.0;  // [Hz]

class MotionSlicerTest : public ::testing::Test {
 protected:
  /// So many seconds of a turning rotor, or of a resting one.
  void pass(double seconds, double speed = 0.5, bool has_currents = true, double current = 0.5) {
    for (int n = 0; n < static_cast<int>(seconds * kSlicedRate); ++n) {
      now_ += 1.0 / kSlicedRate;
      spin_ += speed / kSlicedRate;
      const auto stamp = static_cast<Stamp>(std::llround(now_ * 1e9));
      slicer_.add(JointMeasurement{stamp, Eigen::Vector3d(0.1, 0.0, spin_)});
      if (has_currents) {
        slicer_.add(CurrentMeasurement{stamp, Eigen::Vector2d::Constant(current)});
      }
      slicer_.add(OrientationMeasurement{stamp + 1, Eigen::Quaterniond::Identity()});
      while (auto slice = slicer_.take()) {
        slices_.push_back(std::move(*slice));
      }
    }
  }
  std::size_t countLeftOut(const std::string& reason) const {
    for (const WindowsLeftOut& left_out : slicer_.leftOut()) {
      if (left_out.reason == reason) {
        return left_out.count;
      }
    }
    return 0;
  }

  double now_ = 1000.0;
  double spin_ = 0.0;
  MotionOptions options_;
  MotionSlicer slicer_{kCoils, options_};
  std::vector<MotionSlice> slices_;
};

TEST_F(MotionSlicerTest, WindowsFollowEachOther) {
  pass(10.0);
  // 40 windows, less one at the begin without currents before it, and what is not over yet.
  ASSERT_GE(slices_.size(), 37U);
  for (std::size_t n = 0; n < slices_.size(); ++n) {
    const MotionSlice& slice = slices_[n];
    const MotionSpan span(slice.streams);
    EXPECT_TRUE(refusalOf(span, {0, slice.window.first, slice.window.last}, options_).empty());
    EXPECT_EQ(slice.window.last - slice.window.first, 50U);
    if (n > 0) {
      const MotionSlice& before = slices_[n - 1];
      EXPECT_EQ(slice.streams.joint_stamps[slice.window.first],
                before.streams.joint_stamps[before.window.last]);
      EXPECT_GT(slice.streams.orientation_stamps.front(), before.streams.orientation_stamps.back());
      EXPECT_EQ(slice.streams.orientation_stamps.size(), 50U);
    }
  }
}

TEST_F(MotionSlicerTest, NeedsCurrentsWithinTheirLargestDelay) {
  pass(2.0, 0.5, false);
  pass(2.0);
  for (const MotionSlice& slice : slices_) {
    const Stamp begin = slice.streams.joint_stamps[slice.window.first];
    EXPECT_LT(1e-9 * static_cast<double>(slice.streams.current_stamps.front() - begin),
              -options_.largest_delay);
  }
  EXPECT_GE(countLeftOut("currents are missing"), 8U);
  EXPECT_LE(countLeftOut("currents are missing"), 9U);
}

TEST_F(MotionSlicerTest, ToldFromWhatIsNoWindow) {
  pass(2.0);
  ASSERT_FALSE(slices_.empty());
  const MotionSlice slice = slices_.front();
  const auto refusal = [&](auto spoil) {
    MotionSlice other = slice;
    spoil(other);
    return errorMessage<DataError>([&] { validate(other, kCoils, MotionOptions()); });
  };
  EXPECT_EQ(refusal([](MotionSlice&) {}), "no exception");
  for (const std::string& message : {
           refusal([](MotionSlice& other) { other.window.first = 0; }),
           refusal([](MotionSlice& other) { other.window.last = other.window.first + 2; }),
           refusal([](MotionSlice& other) { other.window.last = other.streams.joints.size(); }),
           refusal([](MotionSlice& other) { other.streams = {}; }),
           refusal([](MotionSlice& other) {
             other.streams.joint_stamps[3] = other.streams.joint_stamps[2];
           }),
           refusal([](MotionSlice& other) { other.streams.joints[3][1] = std::nan(""); }),
           refusal([](MotionSlice& other) { other.streams.currents(3, 1) = std::nanf(""); }),
           refusal([](MotionSlice& other) { other.streams.currents = StreamCurrents(3, 2); }),
           refusal([](MotionSlice& other) { other.streams.orientations[1].w() = 2.0; }),
       }) {
    EXPECT_EQ(message, "A window of a motion holds none.");
  }
  EXPECT_NE(refusal([](MotionSlice& other) {
              other.streams.currents.matrix().setZero();
            }).find("no coil is on"),
            std::string::npos);
}

TEST_F(MotionSlicerTest, LeavesOutRestsHolesAndHands) {
  pass(5.0, 0.0);
  EXPECT_TRUE(slices_.empty());
  EXPECT_GE(countLeftOut("the rotor rests"), 17U);
  pass(5.0, 0.5, true, 0.0);
  // The currents of before are within the largest delay of two windows.
  EXPECT_LE(slices_.size(), 2U);
  EXPECT_GE(countLeftOut("no coil is on"), 17U);
  pass(1.0);
  now_ += 0.1;
  pass(1.0);
  // In the window, or beside one.
  EXPECT_GE(countLeftOut("joint readings are missing"), 1U);
  EXPECT_LE(countLeftOut("joint readings are missing"), 2U);
  const std::size_t before = slices_.size();
  now_ -= 100.0;
  pass(1.0);
  EXPECT_GE(slices_.size(), before + 2);
}

TEST_F(MotionSlicerTest, TakesNoJumpOfASensorThatWrapsAround) {
  spin_ = 3.0;
  for (int n = 0; n < 400; ++n) {
    now_ += 1.0 / kSlicedRate;
    spin_ += 0.5 / kSlicedRate;
    const auto stamp = static_cast<Stamp>(std::llround(now_ * 1e9));
    const double read = std::remainder(spin_, 2.0 * std::acos(-1.0));
    slicer_.add(JointMeasurement{stamp, Eigen::Vector3d(0.1, 0.0, read)});
    slicer_.add(CurrentMeasurement{stamp, Eigen::Vector2d::Constant(0.5)});
  }
  while (auto slice = slicer_.take()) {
    for (std::size_t n = 1; n < slice->streams.joints.size(); ++n) {
      EXPECT_LT(std::abs(slice->streams.joints[n][2] - slice->streams.joints[n - 1][2]), 0.1);
    }
  }
}

TEST_F(MotionSlicerTest, HoldsOutAgainstAFloodOfOneStream) {
  pass(1.0);
  for (Stamp n = 1; n < 1'000'000; ++n) {
    slicer_.add(CurrentMeasurement{2'000'000'000'000 + n, Eigen::Vector2d::Ones()});
  }
  now_ = 3000.0;
  slices_.clear();
  pass(2.0);
  EXPECT_GE(slices_.size(), 4U);
  for (const MotionSlice& slice : slices_) {
    EXPECT_LE(slice.streams.current_stamps.size(), 100U);
  }
}

}  // namespace
}  // namespace sac
