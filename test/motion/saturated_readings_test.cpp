#include "saturated_readings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr int kReadings = 4000;  // at 1 kHz

/// Two coils and three joints that move, with noise.
MotionStreams movingStreams() {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  MotionStreams streams;
  streams.currents = StreamCurrents(kReadings, 2);
  for (int n = 0; n < kReadings; ++n) {
    const double t = 1e-3 * n;
    const auto stamp = static_cast<Stamp>(1e9 * (10.0 + t));
    streams.joint_stamps.push_back(stamp);
    streams.current_stamps.push_back(stamp);
    const Eigen::Vector3d noise(normal(generator), normal(generator), normal(generator));
    streams.joints.emplace_back(
        Eigen::Vector3d(0.2 * std::sin(5.0 * t), 0.2 * std::cos(7.0 * t), 0.3 * std::sin(4.0 * t)) +
        1e-6 * noise);
    streams.currents(n, 0) = static_cast<float>(
        0.3 * std::sin(31.0 * t) + 0.3 * std::cos(53.0 * t) + 1e-3 * normal(generator));
    streams.currents(n, 1) = static_cast<float>(
        0.3 * std::cos(37.0 * t) + 0.3 * std::sin(59.0 * t) + 1e-3 * normal(generator));
  }
  return streams;
}

/// Told in steps of so much.
void roundCurrents(MotionStreams& streams, float step) {
  auto currents = streams.currents.matrix().array();
  currents = (currents / step).round() * step;
}

/// Windows of a quarter of a second, and in how many of them which reading is at its end.
struct LookedAt {
  std::vector<MotionWindow> windows;
  std::map<std::string, std::size_t> at_end;
};

LookedAt lookedAt(const std::vector<MotionStreams>& recording, double largest_delay = 0.0) {
  constexpr std::size_t kLength = 250;
  std::vector<MotionSpan> spans;
  for (const MotionStreams& streams : recording) {
    spans.emplace_back(streams);
  }
  LookedAt result;
  const SaturatedReadings saturated(spans);
  for (std::size_t s = 0; s < spans.size(); ++s) {
    for (std::size_t first = 2; first + kLength + 2 < spans[s].track.size(); first += kLength) {
      result.windows.push_back({s, first, first + kLength});
      const std::string end = saturated.within(result.windows.back(), largest_delay);
      if (!end.empty()) {
        ++result.at_end[end];
      }
    }
  }
  return result;
}

LookedAt lookedAt(const MotionStreams& streams, double largest_delay = 0.0) {
  return lookedAt(std::vector<MotionStreams>{streams}, largest_delay);
}

/// The same in spans of so many readings.
std::vector<MotionStreams> inSpans(const MotionStreams& streams, int length) {
  std::vector<MotionStreams> spans;
  for (int begin = 0; begin + length <= kReadings; begin += length) {
    MotionStreams part;
    part.currents = StreamCurrents(streams.currents.matrix().middleRows(begin, length));
    for (int n = begin; n < begin + length; ++n) {
      const auto place = static_cast<std::size_t>(n);
      part.joint_stamps.push_back(streams.joint_stamps[place]);
      part.current_stamps.push_back(streams.current_stamps[place]);
      part.joints.push_back(streams.joints[place]);
    }
    spans.push_back(part);
  }
  return spans;
}

TEST(SaturatedReadings, AreNotAmongSoundOnes) {
  EXPECT_TRUE(lookedAt(movingStreams()).at_end.empty());
  for (const float step : {1e-3F, 1e-2F, 0.05F}) {
    MotionStreams coarse = movingStreams();
    roundCurrents(coarse, step);
    EXPECT_TRUE(lookedAt(coarse).at_end.empty()) << step;
  }
}

TEST(SaturatedReadings, OfACoilSpoilTheirWindowsAlone) {
  constexpr float kMost = 0.45F;
  for (const float step : {0.0F, 1e-3F}) {
    MotionStreams streams = movingStreams();
    std::vector<bool> is_clipped;
    for (int n = 0; n < kReadings; ++n) {
      is_clipped.push_back(streams.currents(n, 1) > kMost);
      streams.currents(n, 1) = std::min(streams.currents(n, 1), kMost);
    }
    if (step > 0.0F) {
      roundCurrents(streams, step);
    }
    const LookedAt looked = lookedAt(streams);
    std::size_t clipped = 0;
    for (const MotionWindow& window : looked.windows) {
      const auto begin = is_clipped.begin() + static_cast<std::ptrdiff_t>(window.first);
      const auto end = is_clipped.begin() + static_cast<std::ptrdiff_t>(window.last);
      clipped += std::any_of(begin, end, [](bool one) { return one; }) ? 1 : 0;
    }
    ASSERT_GT(clipped, 3U);
    ASSERT_LT(clipped, looked.windows.size());
    const std::string end =
        "the current of coil 2 reads no further than 0.45 A, as at the end of its sensor's range";
    EXPECT_EQ(looked.at_end, (std::map<std::string, std::size_t>{{end, clipped}})) << step;
    // Currents count later than they are stamped.
    EXPECT_GT(lookedAt(streams, 0.06).at_end[end], clipped);
    // In windows of a session each is a span.
    EXPECT_GT(lookedAt(inSpans(streams, 260)).at_end[end], clipped / 2);
  }
}

TEST(SaturatedReadings, OfAJointToo) {
  MotionStreams streams = movingStreams();
  for (Eigen::Vector3d& joints : streams.joints) {
    joints[0] = std::max(joints[0], -0.15);
  }
  const LookedAt looked = lookedAt(streams);
  ASSERT_EQ(looked.at_end.size(), 1U);
  EXPECT_EQ(looked.at_end.begin()->first,
            "joint 1 reads no further than -0.15 rad, as at the end of its sensor's range");
}

TEST(SaturatedReadings, AreNoneWhereTheRotorRestsAtTheEndOfItsWay) {
  MotionStreams streams = movingStreams();
  constexpr double kStep = 1e-4;  // of the encoders [rad]
  for (int n = 0; n < kReadings; ++n) {
    const double way = 0.2 * std::min(1.0, 1.1 + std::sin(6.0 * 1e-3 * n));
    const Eigen::Vector3d joints = way * Eigen::Vector3d(1.0, 0.5, 0.7);
    streams.joints[static_cast<std::size_t>(n)] = (joints.array() / kStep).round() * kStep;
  }
  EXPECT_TRUE(lookedAt(streams).at_end.empty());
}

}  // namespace
}  // namespace sac
