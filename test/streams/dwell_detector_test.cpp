#include "spherical_actuator_calibration/streams/dwell_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "streams/scripted_dwell.hpp"
#include "support/synthetic_streams.hpp"

namespace sac {
namespace {

using synthetic::Script;
using synthetic::Sensors;
using synthetic::stampAt;
using synthetic::Streams;
using synthetic::timeOf;

std::vector<StampInterval> dwellsOf(const std::vector<JointMeasurement>& joints,
                                    const SampleBuilderOptions& options = {}) {
  DwellDetector detector(options);
  std::vector<StampInterval> dwells;
  for (const JointMeasurement& joint : joints) {
    if (const auto dwell = detector.add(joint.stamp, joint.position)) {
      dwells.push_back(*dwell);
    }
  }
  if (const auto dwell = detector.close()) {
    dwells.push_back(*dwell);
  }
  return dwells;
}

std::vector<JointMeasurement> jointsOf(const Script& script, std::uint64_t seed = 1) {
  return synthetic::record(script, Sensors(), seed).joints;
}

TEST(SlidingExtremes, IsTheSpreadOfTheWindow) {
  std::mt19937_64 generator(8);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr Stamp kWindow = 40;
  SlidingExtremes extremes;
  std::vector<double> values;
  for (Stamp stamp = 0; stamp < 2000; ++stamp) {
    // Rising, falling and random stretches; some values repeat.
    const double trend = (stamp / 500) % 2 == 0 ? 0.02 : -0.02;
    values.push_back(std::round(100.0 * (trend * static_cast<double>(stamp) + uniform(generator))));
    extremes.dropBefore(stamp - kWindow);
    extremes.add(stamp, values.back());
    const auto begin = values.end() - std::min<std::ptrdiff_t>(stamp, kWindow) - 1;
    const auto [smallest, largest] = std::minmax_element(begin, values.end());
    ASSERT_EQ(extremes.spread(), *largest - *smallest) << stamp;
  }
}

TEST(DwellDetector, FindsTheRestBetweenTwoMoves) {
  const Script script = Script(0).moveTo(rest_pose).rest(2.0).moveTo(-rest_pose);
  const std::vector<StampInterval> dwells = dwellsOf(jointsOf(script));
  ASSERT_EQ(dwells.size(), 1U);
  // The ends of a minimum-jerk move are slow: less than the settle time of it is within the limit.
  EXPECT_NEAR(timeOf(dwells[0].begin), 0.8, 0.15);
  EXPECT_NEAR(timeOf(dwells[0].end), 2.8, 0.15);
}

TEST(DwellDetector, ARestShorterThanTheWindowIsNone) {
  EXPECT_TRUE(
      dwellsOf(jointsOf(Script(0).moveTo(rest_pose, 0.3).rest(0.15).moveTo(-rest_pose, 0.3)))
          .empty());
}

TEST(DwellDetector, ASteadyMoveIsNoRest) {
  const Script script = Script(0).driftBy(Eigen::Vector3d(0.0, 0.1, 0.0), 10.0);
  EXPECT_TRUE(dwellsOf(jointsOf(script)).empty());
}

TEST(DwellDetector, EveryJointCounts) {
  for (int k = 0; k < 3; ++k) {
    const Script script =
        Script(0).rest(1.0).driftBy(0.1 * Eigen::Vector3d::Unit(k), 1.0).rest(1.0);
    EXPECT_EQ(dwellsOf(jointsOf(script)).size(), 2U) << "joint " << k;
  }
}

TEST(DwellDetector, OneGlitchDoesNotEndADwell) {
  std::vector<JointMeasurement> joints = jointsOf(Script(0).rest(3.0));
  joints[300].position.y() += 1.0;
  EXPECT_EQ(dwellsOf(joints).size(), 1U);
  joints[301].position.y() += 1.0;
  EXPECT_EQ(dwellsOf(joints).size(), 2U);
}

TEST(DwellDetector, AHoleEndsADwell) {
  std::vector<JointMeasurement> joints = jointsOf(Script(0).rest(3.0));
  joints.erase(joints.begin() + 300, joints.begin() + 340);
  EXPECT_EQ(dwellsOf(joints).size(), 1U);
  joints.erase(joints.begin() + 300, joints.begin() + 320);
  const std::vector<StampInterval> dwells = dwellsOf(joints);
  ASSERT_EQ(dwells.size(), 2U);
  EXPECT_LE(timeOf(dwells[0].end), 1.5);
  EXPECT_GE(timeOf(dwells[1].begin), 1.8);
}

TEST(DwellDetector, CutsALongDwell) {
  SampleBuilderOptions options;
  options.largest_dwell = 5.0;
  const std::vector<StampInterval> dwells = dwellsOf(jointsOf(Script(0).rest(21.0)), options);
  ASSERT_EQ(dwells.size(), 5U);
  for (const StampInterval& dwell : dwells) {
    EXPECT_LE(dwell.duration(), 5.01);
  }
}

TEST(DwellDetector, DwellsNeverOverlapNorComeBeforeTheEarliestBegin) {
  // A slow wobble close to the limit makes and ends dwells in every way.
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> step(-1.0, 1.0);
  DwellDetector detector{SampleBuilderOptions()};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Stamp previous_end = 0;
  int dwells = 0;
  for (int i = 0; i < 200000; ++i) {
    position.x() += 2e-4 * step(generator);
    const std::optional<Stamp> earliest = detector.earliestBegin();
    const auto dwell = detector.add(stampAt(0.005 * i), position);
    if (!dwell) {
      continue;
    }
    ++dwells;
    EXPECT_GT(dwell->begin, previous_end);
    EXPECT_GE(dwell->begin, *earliest);
    EXPECT_LT(dwell->begin, dwell->end);
    previous_end = dwell->end;
  }
  EXPECT_GT(dwells, 100);
}

}  // namespace
}  // namespace sac
