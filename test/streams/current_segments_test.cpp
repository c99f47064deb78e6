#include "current_segments.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "streams/coils_in_turn.hpp"
#include "support/synthetic_streams.hpp"

namespace sac {
namespace {

using synthetic::Script;
using synthetic::stampAt;
using synthetic::timeOf;

StreamBuffer currentsOf(const Script& script) {
  StreamBuffer buffer(kCoilsInTurn);
  for (const CurrentMeasurement& measurement : synthetic::record(script, {}, 2).currents) {
    buffer.push(measurement.stamp, measurement.current.data());
  }
  return buffer;
}

std::vector<CurrentSegment> longSegments(const StreamBuffer& buffer) {
  const SampleBuilderOptions options;
  std::vector<CurrentSegment> segments =
      segmentsOfConstantCurrent(buffer, {stampAt(0.0), stampAt(100.0)}, options);
  segments.erase(std::remove_if(segments.begin(),
                                segments.end(),
                                [&options](const CurrentSegment& segment) {
                                  return segment.span.duration() < options.smallest_duration;
                                }),
                 segments.end());
  return segments;
}

TEST(CurrentSegments, CutsWhereThePatternChanges) {
  const Script script =
      Script(kCoilsInTurn).rest(0.5).excite(0, 2.0, 0.5).excite(2, -1.0, 0.5).rest(0.5);
  const std::vector<CurrentSegment> segments = longSegments(currentsOf(script));
  ASSERT_EQ(segments.size(), 4U);
  EXPECT_FALSE(segments[0].excited);
  EXPECT_TRUE(segments[1].excited);
  EXPECT_TRUE(segments[2].excited);
  EXPECT_FALSE(segments[3].excited);
  EXPECT_TRUE(segments[1].current.isApprox(Eigen::Vector3d(2.0, 0.0, 0.0), 1e-3));
  EXPECT_TRUE(segments[2].current.isApprox(Eigen::Vector3d(0.0, 0.0, -1.0), 1e-3));
  for (std::size_t k = 0; k < segments.size(); ++k) {
    EXPECT_NEAR(timeOf(segments[k].span.begin), 0.5 * static_cast<double>(k), 0.01);
    EXPECT_NEAR(timeOf(segments[k].span.end), 0.5 * static_cast<double>(k + 1), 0.01);
  }
}

TEST(CurrentSegments, LeavesRampsOut) {
  const Script script = Script(kCoilsInTurn).rest(0.5).rampTo(1, 2.0, 1.0).excite(1, 2.0, 0.5);
  const std::vector<CurrentSegment> segments = longSegments(currentsOf(script));
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_NEAR(timeOf(segments[0].span.end), 0.5, 0.03);
  EXPECT_NEAR(timeOf(segments[1].span.begin), 1.5, 0.03);
}

TEST(CurrentSegments, PassesOverOneDeviatingMeasurement) {
  std::vector<CurrentMeasurement> stream =
      synthetic::record(Script(kCoilsInTurn).excite(0, 2.0, 1.0), {}, 2).currents;
  stream[100].current[1] = 5.0;
  StreamBuffer buffer(kCoilsInTurn);
  for (const CurrentMeasurement& measurement : stream) {
    buffer.push(measurement.stamp, measurement.current.data());
  }
  const std::vector<CurrentSegment> segments = longSegments(buffer);
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_NEAR(segments[0].current[1], 0.0, 1e-3);
  const MeanCurrent mean = meanCurrent(buffer, segments[0].span, segments[0], {});
  EXPECT_EQ(mean.count, stream.size() - 1);
  EXPECT_TRUE(mean.current.isApprox(Eigen::Vector3d(2.0, 0.0, 0.0), 1e-3));
}

TEST(CurrentSegments, AHoleEndsASegment) {
  std::vector<CurrentMeasurement> stream =
      synthetic::record(Script(kCoilsInTurn).excite(0, 2.0, 2.0), {}, 2).currents;
  stream.erase(stream.begin() + 150, stream.begin() + 210);
  StreamBuffer buffer(kCoilsInTurn);
  for (const CurrentMeasurement& measurement : stream) {
    buffer.push(measurement.stamp, measurement.current.data());
  }
  EXPECT_EQ(longSegments(buffer).size(), 2U);
}

TEST(CurrentSegments, AnEmptyDwellHasNone) {
  EXPECT_TRUE(longSegments(StreamBuffer(kCoilsInTurn)).empty());
}

}  // namespace
}  // namespace sac
