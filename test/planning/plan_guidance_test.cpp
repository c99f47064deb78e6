#include "spherical_actuator_calibration/planning/plan_guidance.hpp"

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "planning/current_threshold.hpp"
#include "planning/plan_step.hpp"
#include "spherical_actuator_calibration/planning/planned_pose.hpp"
#include "spherical_actuator_calibration/planning/pose_plan.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

namespace sac {
namespace {

Sample sampleAt(const Eigen::Vector3d& joints, const std::vector<double>& currents) {
  Sample sample;
  sample.joint_position = joints;
  sample.current = Eigen::Map<const Eigen::VectorXd>(currents.data(), 3);
  return sample;
}

TEST(PlanGuidance, LeadsFromPoseToPose) {
  const Eigen::Vector3d first(0.1, -0.2, 1.5);
  const Eigen::Vector3d second(0.0, 0.3, 0.0);
  const std::vector<PlannedPose> plan = {{first, {0, 2}, {}}, {second, {}, {}}};
  std::vector<Sample> samples;
  EXPECT_EQ(planStep(plan, samples, kThreshold),
            "Go on with the plan, 0 of 2 poses are measured: turn the rotor to joints 0.10, -0.20, "
            "1.50 rad (6, -11, 86 deg) and capture without current, then with coil 1 and 3 excited "
            "in turn.");
  samples.push_back(sampleAt(first, {2.0, 0.0, 0.0}));
  EXPECT_NE(planStep(plan, samples, kThreshold).find("then with coil 3 excited."),
            std::string::npos);
  samples.push_back(sampleAt(first + Eigen::Vector3d(0.0, 0.04, 0.0), {0.0, 0.0, 2.0}));
  EXPECT_EQ(planStep(plan, samples, kThreshold),
            "Go on with the plan, 1 of 2 poses is measured: turn the rotor to joints 0.00, 0.30, "
            "0.00 rad (0, 17, 0 deg) and capture.");
  samples.push_back(sampleAt(second, {0.0, 0.0, 0.0}));
  EXPECT_EQ(planStep(plan, samples, kThreshold), "");
}

// A bound that is far below may be the bound's fault: no plan was shown to be better.
TEST(PlanGuidance, CallsADistanceToTheBoundByThatNameOnlyWhereItIsSmall) {
  PosePlan plan;
  plan.poses.resize(2);
  plan.worst_stddev = 0.206e-3;
  plan.stddev_bound = 0.2e-3;
  EXPECT_NE(planSentence(plan, 0.0).find("within 3.0 % of what any plan"), std::string::npos)
      << planSentence(plan, 0.0);
  plan.worst_stddev = 0.44e-3;
  const std::string far = planSentence(plan, 0.0);
  EXPECT_EQ(far.find("within"), std::string::npos) << far;
  EXPECT_NE(far.find("could reach less than 0.2 mrad; whether any comes nearer to that is not"),
            std::string::npos)
      << far;
}

TEST(PlanGuidance, TellsSignsOfPatterns) {
  PlannedPose pose{Eigen::Vector3d::Zero(), {0, 1, 2}, {}};
  pose.patterns = {{{0, 1}, {2, -1}}, {{1, 1}, {2, 1}}};
  std::vector<Sample> samples;
  EXPECT_NE(
      planStep({pose}, samples, kThreshold)
          .find("capture without current, then with coils (+1 -3) and (+2 +3) excited in turn."),
      std::string::npos)
      << planStep({pose}, samples, kThreshold);
  // Neither a coil alone nor other signs; the opposite tells the same.
  samples = {sampleAt(Eigen::Vector3d::Zero(), {2.0, 0.0, 0.0}),
             sampleAt(Eigen::Vector3d::Zero(), {2.0, 0.0, 2.0}),
             sampleAt(Eigen::Vector3d::Zero(), {0.0, -2.0, -2.0})};
  EXPECT_NE(planStep({pose}, samples, kThreshold).find("then with coils (+1 -3) excited."),
            std::string::npos)
      << planStep({pose}, samples, kThreshold);
  samples.push_back(sampleAt(Eigen::Vector3d::Zero(), {2.0, 0.0, -2.0}));
  EXPECT_EQ(planStep({pose}, samples, kThreshold), "");
}

TEST(PlanGuidance, TellsWhichSamplesAreToBeHeldOut) {
  PlanProgress progress(kThreshold);
  progress.addPose({Eigen::Vector3d::Zero(), {{{1, 1}}}, true});
  EXPECT_NE(progress.nextStep().find("and capture (held out) without current, then with coil 2"),
            std::string::npos)
      << progress.nextStep();
  Sample sample = sampleAt(Eigen::Vector3d::Zero(), {0.0, 2.0, 0.0});
  EXPECT_FALSE(progress.add(sample));
  EXPECT_NE(progress.nextStep(), "");
  sample.validation = true;
  EXPECT_TRUE(progress.add(sample));
  EXPECT_EQ(progress.nextStep(), "");
}

TEST(PlanGuidance, DistantSamplesCarryOutNothing) {
  const std::vector<PlannedPose> plan = {{Eigen::Vector3d::Zero(), {}, {}}};
  const auto step = [&](double q) {
    return planStep(plan, {sampleAt(Eigen::Vector3d(0.0, -q, q), {0.0, 0.0, 0.0})}, kThreshold);
  };
  EXPECT_NE(step(kPoseTolerance + 0.01), "");
  EXPECT_EQ(step(kPoseTolerance - 0.01), "");
}

TEST(PlanGuidance, GoesOnFromSampleToSample) {
  const Eigen::Vector3d first(0.1, -0.2, 1.5);
  const Eigen::Vector3d near_first = first + Eigen::Vector3d(0.0, 0.04, 0.0);
  const Eigen::Vector3d second(0.0, 0.3, 0.0);
  const std::vector<PlannedPose> plan = {
      {first, {0, 2}, {}}, {near_first, {2}, {}}, {second, {}, {}}};
  const std::vector<Sample> samples = {sampleAt(first, {2.0, 0.0, 0.0}),
                                       sampleAt(near_first, {0.0, 0.0, -2.0}),
                                       sampleAt(second, {0.0, 0.0, 0.0})};
  PlanProgress progress(kThreshold);
  for (const PlannedPose& pose : plan) {
    progress.addPose({pose.joint_position, pose.excitations()});
  }
  std::vector<Sample> so_far;
  for (const Sample& sample : samples) {
    EXPECT_EQ(progress.nextStep(), planStep(plan, so_far, kThreshold));
    so_far.push_back(sample);
    progress.add(sample);
  }
  EXPECT_EQ(progress.nextStep(), "");
  so_far.erase(so_far.begin() + 1);
  progress.countAnew(so_far);
  EXPECT_NE(progress.nextStep().find("1 of 3 poses"), std::string::npos) << progress.nextStep();
}

}  // namespace
}  // namespace sac
