#include "spherical_actuator_calibration/planning/pose_progress.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "planning/current_threshold.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/planning/plan_guidance.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

namespace sac {
namespace {

Eigen::Vector3d place() {
  return {0.1, -0.2, 1.5};
}

/// Three coils, the first two of them against each other at once, and the last alone.
PoseToMeasure pose(bool validation = false) {
  return {place(), {{{2, 1}}, {{0, 1}, {1, -1}}}, validation};
}

Sample sampleOf(const std::vector<double>& currents, bool validation = false) {
  Sample sample;
  sample.joint_position = place();
  sample.current = Eigen::Map<const Eigen::VectorXd>(currents.data(), 3);
  sample.validation = validation;
  return sample;
}

/// What samples leave open, in words.
std::vector<std::string> missing(const PoseProgress& progress) {
  std::vector<std::string> texts;
  for (const CoilPattern& pattern : progress.missing()) {
    texts.push_back(patternText(pattern));
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(PoseProgress, LacksEachPatternThatNoSampleHas) {
  PoseProgress progress(pose());
  EXPECT_FALSE(progress.hasSample());
  EXPECT_EQ(missing(progress), (Texts{"+3", "+1 -2"}));
  // A coil that is off may show a little; neither a coil alone nor other signs are the pattern.
  EXPECT_TRUE(progress.add(sampleOf({0.01, -0.01, 2.0}), kThreshold));
  EXPECT_FALSE(progress.add(sampleOf({2.0, 0.0, 0.0}), kThreshold));
  EXPECT_FALSE(progress.add(sampleOf({2.0, 2.0, 0.0}), kThreshold));
  EXPECT_FALSE(progress.add(sampleOf({2.0, -2.0, 2.0}), kThreshold));
  EXPECT_EQ(missing(progress), Texts{"+1 -2"});
  EXPECT_FALSE(progress.isMeasured());
  EXPECT_TRUE(progress.add(sampleOf({2.0, -2.0, 0.0}), kThreshold));
  EXPECT_TRUE(progress.isMeasured());
}

TEST(PoseProgress, TakesTheOppositeOfAPattern) {
  PoseProgress progress(pose());
  EXPECT_TRUE(progress.add(sampleOf({-2.0, 2.0, 0.0}), kThreshold));
  EXPECT_EQ(missing(progress), Texts{"+3"});
  EXPECT_TRUE(progress.add(sampleOf({0.0, 0.0, -2.0}), kThreshold));
  EXPECT_TRUE(progress.isMeasured());
}

// One of them tells what both do.
TEST(PoseProgress, AsksOnceForAPatternAndItsOpposite) {
  PoseProgress progress({place(), {{{1, -1}}, {{2, 1}}, {{1, 1}}, {{2, 1}}}});
  EXPECT_EQ(missing(progress), (Texts{"-2", "+3"}));
  progress.add(sampleOf({0.0, 2.0, 0.0}), kThreshold);
  EXPECT_EQ(missing(progress), Texts{"+3"});
}

TEST(PoseProgress, IsOfTheSamplesThatAreHeldOutAsThePoseIs) {
  PoseProgress to_fit(pose());
  EXPECT_FALSE(to_fit.add(sampleOf({0.0, 0.0, 2.0}, true), kThreshold));
  EXPECT_FALSE(to_fit.hasSample());
  EXPECT_EQ(missing(to_fit), (Texts{"+3", "+1 -2"}));
  PoseProgress to_judge(pose(true));
  EXPECT_FALSE(to_judge.add(sampleOf({0.0, 0.0, 2.0}), kThreshold));
  EXPECT_FALSE(to_judge.hasSample());
  EXPECT_TRUE(to_judge.add(sampleOf({0.0, 0.0, 2.0}, true), kThreshold));
  EXPECT_EQ(missing(to_judge), Texts{"+1 -2"});
}

// It serves those of its rest: with none left to serve it is not asked for.
TEST(PoseProgress, NeverLacksTheSampleWithoutCurrentAlone) {
  PoseProgress progress(pose());
  EXPECT_TRUE(progress.add(sampleOf({0.0, 0.0, 0.0}), kThreshold));
  EXPECT_TRUE(progress.hasSample());
  EXPECT_EQ(missing(progress), (Texts{"+3", "+1 -2"}));
  progress.beginAnew();
  progress.add(sampleOf({0.0, 0.0, 2.0}), kThreshold);
  progress.add(sampleOf({2.0, -2.0, 0.0}), kThreshold);
  EXPECT_TRUE(progress.isMeasured());
}

TEST(PoseProgress, WithoutPatternsIsMeasuredByAnySample) {
  for (const std::vector<double>& currents :
       {std::vector<double>{0.0, 0.0, 0.0}, {2.0, 0.0, 2.0}}) {
    PoseProgress progress({place(), {}});
    EXPECT_FALSE(progress.isMeasured());
    EXPECT_TRUE(progress.add(sampleOf(currents), kThreshold));
    EXPECT_TRUE(progress.isMeasured());
    EXPECT_FALSE(progress.add(sampleOf(currents), kThreshold));
  }
}

TEST(PoseProgress, IsOfSamplesNearThePoseAFullTurnAwayToo) {
  Sample sample = sampleOf({0.0, 0.0, 2.0});
  sample.joint_position.z() = place().z() + 2.0 * kPi + kPoseTolerance + 0.001;
  PoseProgress progress(pose());
  EXPECT_FALSE(progress.add(sample, kThreshold));
  sample.joint_position.z() -= 0.002;
  EXPECT_TRUE(progress.add(sample, kThreshold));
}

TEST(PoseProgress, KnowsWhetherAnySampleHasCurrent) {
  PoseProgress progress(pose());
  progress.add(sampleOf({0.0, 0.0, 0.0}), kThreshold);
  EXPECT_FALSE(progress.hasCurrent());
  // No pattern of the pose; it counts all the same.
  EXPECT_TRUE(progress.add(sampleOf({2.0, 0.0, 0.0}), kThreshold));
  EXPECT_TRUE(progress.hasCurrent());
  progress.beginAnew();
  EXPECT_FALSE(progress.hasCurrent());
}

TEST(PoseProgress, OpensAgainWhatARemovedSampleHad) {
  PlanProgress plan(kThreshold);
  plan.addPose(pose());
  plan.addPose({Eigen::Vector3d::Zero(), {}});
  Sample elsewhere = sampleOf({0.0, 0.0, 0.0});
  elsewhere.joint_position.setZero();
  std::vector<Sample> samples = {
      sampleOf({0.0, 0.0, 2.0}), sampleOf({2.0, -2.0, 0.0}), sampleOf({0.0, 0.0, -2.0}), elsewhere};
  for (const Sample& sample : samples) {
    plan.add(sample);
  }
  EXPECT_TRUE(plan.poses()[0].isMeasured());
  EXPECT_TRUE(plan.poses()[1].isMeasured());
  // Another sample has the opposite.
  samples.erase(samples.begin());
  plan.countAnew(samples);
  EXPECT_TRUE(plan.poses()[0].isMeasured());
  samples.erase(samples.begin());
  plan.countAnew(samples);
  EXPECT_EQ(missing(plan.poses()[0]), Texts{"+1 -2"});
  samples.clear();
  plan.countAnew(samples);
  EXPECT_FALSE(plan.poses()[0].hasSample());
  EXPECT_FALSE(plan.poses()[1].isMeasured());
}

}  // namespace
}  // namespace sac
