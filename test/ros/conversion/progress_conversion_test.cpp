#include "spherical_actuator_calibration/ros/conversion/progress_conversion.hpp"

#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

using Numbers = std::vector<std::int32_t>;

msg::PosePatterns poseMessage(const std::vector<Numbers>& patterns) {
  msg::PosePatterns message;
  message.joint_position = {0.1, -0.2, 1.5};
  for (const Numbers& coils : patterns) {
    message.patterns.emplace_back().coils = coils;
  }
  message.validation = 1;
  return message;
}

TEST(ProgressConversion, KeepsAPoseWithTheSignsOfItsCoils) {
  const PoseToMeasure pose = poseFromRos(poseMessage({{3}, {-1, 4}}), 4);
  EXPECT_EQ(pose.joint_position, Eigen::Vector3d(0.1, -0.2, 1.5));
  EXPECT_EQ(pose.patterns, (std::vector<CoilPattern>{{{2, 1}}, {{0, -1}, {3, 1}}}));
  EXPECT_TRUE(pose.validation);
}

TEST(ProgressConversion, RefusesCoilsThatAreNone) {
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  for (const Numbers& coils : {Numbers{}, {0}, {5}, {-5}, {kLeast}, {2, 1}, {1, -1}}) {
    EXPECT_THROW(poseFromRos(poseMessage({{1}, coils}), 4), ConfigError) << coils.size();
  }
}

TEST(ProgressConversion, TellsWhatIsMissing) {
  PoseProgress progress(poseFromRos(poseMessage({{3}, {-1, 4}}), 4));
  msg::PoseProgress message = progressToRos(progress);
  EXPECT_EQ(message.pose, poseMessage({{3}, {-1, 4}}));
  EXPECT_FALSE(message.has_sample);
  ASSERT_EQ(message.missing.size(), 2U);
  EXPECT_EQ(message.missing[1].coils, (Numbers{-1, 4}));
  Sample sample;
  sample.joint_position = progress.pose().joint_position;
  sample.validation = true;
  sample.current = Eigen::Vector4d(-2.0, 0.0, 0.0, 2.0);
  progress.add(sample, 0.05);
  message = progressToRos(std::vector<PoseProgress>{progress}).at(0);
  EXPECT_TRUE(message.has_sample);
  EXPECT_FALSE(message.is_measured);
  ASSERT_EQ(message.missing.size(), 1U);
  EXPECT_EQ(message.missing[0].coils, Numbers{3});
  sample.current = Eigen::Vector4d(0.0, 0.0, 2.0, 0.0);
  progress.add(sample, 0.05);
  EXPECT_TRUE(progressToRos(progress).is_measured);
}

}  // namespace
}  // namespace sac
