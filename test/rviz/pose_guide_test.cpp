#include "pose_guide.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

namespace sac {
namespace {

using Coils = std::vector<std::int32_t>;

/// A pose of which patterns are missing; without any it is measured where it `has_sample`.
msg::PoseProgress progress(
    double q1, double q2, double q3, const std::vector<Coils>& missing, bool has_sample = false) {
  msg::PoseProgress pose;
  pose.pose.joint_position = {q1, q2, q3};
  for (const Coils& coils : missing) {
    pose.missing.emplace_back().coils = coils;
  }
  pose.has_sample = static_cast<std::uint8_t>(has_sample);
  pose.is_measured = static_cast<std::uint8_t>(has_sample && missing.empty());
  return pose;
}

msg::PlanProgress plan(const std::vector<msg::PoseProgress>& poses) {
  msg::PlanProgress message;
  message.poses = poses;
  return message;
}

sensor_msgs::JointState joints(double q1, double q2, double q3) {
  sensor_msgs::JointState message;
  message.name = {"joint_3", "joint_1", "joint_2"};
  message.position = {q3, q1, q2};
  return message;
}

class PoseGuideTest : public testing::Test {
 protected:
  PoseGuideTest() {
    guide_.judgeBy(0.05);
    guide_.receive(plan({progress(0.1, 0.0, -1.0, {{2}, {5}}), progress(0.3, 0.2, 1.0, {})}));
  }

  PoseGuide guide_;
};

TEST(PoseGuide, AsksForAPlanFirst) {
  EXPECT_EQ(PoseGuide().advice(), "Plan poses to be led from one to the next.");
}

TEST_F(PoseGuideTest, TellsWhichWayToTurnInDegrees) {
  EXPECT_EQ(guide_.advice(), "Pose 1 of 2: the joint angles are silent.");
  guide_.receive(joints(0.0, 0.01, -0.8));
  EXPECT_EQ(guide_.advice(), "Pose 1 of 2: turn joint_1 by +5.7°, joint_3 by −11.5°.");
  EXPECT_FALSE(guide_.here());
}

TEST_F(PoseGuideTest, JointsOfOtherNamesTellNothing) {
  sensor_msgs::JointState message = joints(0.0, 0.01, -0.8);
  message.name[1] = "elbow";
  guide_.receive(message);
  EXPECT_EQ(guide_.advice(), "Pose 1 of 2: the joint angles are silent.");
}

TEST_F(PoseGuideTest, TellsWhatIsToBeMeasuredThere) {
  guide_.receive(joints(0.11, 0.0, -1.01));
  EXPECT_EQ(guide_.here(), 0U);
  EXPECT_EQ(guide_.advice(),
            "Pose 1 of 2: there. Clamp the rotor, then measure; it excites coil 2, 5 in turn.");
}

TEST_F(PoseGuideTest, GoesOnWhereTheNodeSaysThatAPoseIsMeasured) {
  guide_.receive(joints(0.1, 0.0, -1.0));
  guide_.receive(plan({progress(0.1, 0.0, -1.0, {{5}}, true), progress(0.3, 0.2, 1.0, {})}));
  EXPECT_EQ(guide_.advice(),
            "Pose 1 of 2: there. Clamp the rotor, then measure; it excites coil 5 in turn.");
  guide_.receive(plan({progress(0.1, 0.0, -1.0, {}, true), progress(0.3, 0.2, 1.0, {})}));
  EXPECT_EQ(guide_.next(), 1U);
  EXPECT_EQ(guide_.here(), 0U);
  EXPECT_EQ(guide_.target(), (std::array<double, 3>{0.3, 0.2, 1.0}));
  guide_.receive(joints(0.3, 0.2, 1.0));
  EXPECT_EQ(guide_.advice(), "Pose 2 of 2: there. Clamp the rotor, then measure.");
  guide_.receive(plan({progress(0.1, 0.0, -1.0, {}, true), progress(0.3, 0.2, 1.0, {}, true)}));
  EXPECT_FALSE(guide_.next());
  EXPECT_EQ(guide_.advice(), "All 2 poses are measured.");
  // A sample was removed.
  guide_.receive(plan({progress(0.1, 0.0, -1.0, {{2}}, true), progress(0.3, 0.2, 1.0, {}, true)}));
  EXPECT_EQ(guide_.next(), 0U);
  guide_.receive(plan({}));
  EXPECT_EQ(guide_.advice(), "Plan poses to be led from one to the next.");
}

TEST_F(PoseGuideTest, TellsPatternsOfSeveralCoilsWithTheirSigns) {
  guide_.receive(joints(0.1, 0.0, -1.0));
  guide_.receive(plan({progress(0.1, 0.0, -1.0, {{1, -4}, {2, 3}})}));
  EXPECT_EQ(guide_.advice(),
            "Pose 1 of 1: there. Clamp the rotor, then measure; it excites coils +1 −4, +2 +3 in "
            "turn.");
}

TEST_F(PoseGuideTest, TellsOfAPlanToJudgeBy) {
  msg::PlanProgress to_judge = plan({progress(0.1, 0.0, -1.0, {{2}})});
  to_judge.poses[0].pose.validation = 1;
  guide_.receive(to_judge);
  EXPECT_EQ(guide_.advice(), "Pose 1 of 1, held out: the joint angles are silent.");
  to_judge.poses[0].is_measured = 1;
  guide_.receive(to_judge);
  EXPECT_EQ(guide_.advice(), "The one pose is measured.");
}

TEST_F(PoseGuideTest, LeavesItToASessionToLeadWhileOneWorks) {
  using actionlib_msgs::GoalStatus;
  EXPECT_EQ(guide_.bench(), Bench::kFree);
  actionlib_msgs::GoalStatusArray goals;
  goals.status_list.resize(2);
  goals.status_list[0].status = GoalStatus::ABORTED;
  for (const auto status : {GoalStatus::PENDING, GoalStatus::ACTIVE, GoalStatus::PREEMPTING}) {
    goals.status_list[1].status = status;
    guide_.receive(goals);
    EXPECT_EQ(guide_.bench(), Bench::kInSession);
  }
  goals.status_list[1].status = GoalStatus::PREEMPTED;
  guide_.receive(goals);
  EXPECT_EQ(guide_.bench(), Bench::kFree);
}

TEST_F(PoseGuideTest, MeetsAPoseAsNearAsTheNodeSays) {
  guide_.receive(joints(0.14, -0.04, -1.04));
  EXPECT_EQ(guide_.here(), 0U);
  guide_.receive(joints(0.16, 0.0, -1.0));
  EXPECT_FALSE(guide_.here());
  EXPECT_EQ(guide_.advice(), "Pose 1 of 2: turn joint_1 by −3.4°.");
  guide_.judgeBy(0.07);
  EXPECT_EQ(guide_.here(), 0U);
}

TEST_F(PoseGuideTest, CallsJointsAsTheDescriptionDoes) {
  guide_.nameJoints({"roll", "pitch", "spin"});
  sensor_msgs::JointState message;
  message.name = {"spin", "roll", "pitch"};
  message.position = {-1.0, 0.0, 0.0};
  guide_.receive(message);
  EXPECT_EQ(guide_.advice(), "Pose 1 of 2: turn roll by +5.7°.");
}

TEST_F(PoseGuideTest, OrientationsLeadARotorWithoutJoints) {
  geometry_msgs::QuaternionStamped orientation;
  orientation.quaternion.w = 1.0;
  guide_.receive(orientation);
  EXPECT_EQ(guide_.advice(), "Pose 1 of 2: the joint angles are silent.");
  guide_.followOrientations();
  EXPECT_EQ(guide_.advice(), "Pose 1 of 2: the tracker is silent.");
  // Turned by 0.3 about x, then 0.2 about y, then −3 about z.
  guide_.receive(plan({progress(0.3, 0.2, 3.0, {})}));
  const Eigen::Quaterniond q = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(-3.0, Eigen::Vector3d::UnitZ());
  orientation.quaternion.x = q.x();
  orientation.quaternion.y = q.y();
  orientation.quaternion.z = q.z();
  orientation.quaternion.w = q.w();
  guide_.receive(orientation);
  EXPECT_EQ(guide_.advice(), "Pose 1 of 1: turn rotation_z by −16.2°.");
  orientation.quaternion.w = 2.0;
  guide_.receive(orientation);
  EXPECT_EQ(guide_.advice(), "Pose 1 of 1: turn rotation_z by −16.2°.");
  guide_.judgeBy(0.3);
  EXPECT_EQ(guide_.here(), 0U);
}

TEST_F(PoseGuideTest, KeepsTheLastAnglesWhereAMessageHasNone) {
  guide_.receive(joints(0.1, 0.0, -1.0));
  sensor_msgs::JointState empty;
  guide_.receive(empty);
  EXPECT_EQ(guide_.here(), 0U);
}

}  // namespace
}  // namespace sac
