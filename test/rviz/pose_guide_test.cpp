#include "pose_guide.hpp"

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

namespace sac {
namespace {

using Coils = std::vector<std::uint32_t>;

msg::PlannedPose planned(double q1, double q2, double q3, const Coils& coils) {
  msg::PlannedPose pose;
  pose.joint_position[0] = q1;
  pose.joint_position[1] = q2;
  pose.joint_position[2] = q3;
  pose.coils = coils;
  return pose;
}

sensor_msgs::JointState joints(double q1, double q2, double q3) {
  sensor_msgs::JointState message;
  message.name = {"joint_3", "joint_1", "joint_2"};
  message.position = {q3, q1, q2};
  return message;
}

msg::CalibrationSample sample(double q1, double q2, double q3, const std::vector<double>& current) {
  msg::CalibrationSample message;
  message.joint_position = {q1, q2, q3};
  message.current = current;
  return message;
}

class PoseGuideTest : public testing::Test {
 protected:
  PoseGuideTest() {
    guide_.judgeBy(0.05, 0.1);
    guide_.take({planned(0.1, 0.0, -1.0, {2, 5}), planned(0.3, 0.2, 1.0, {})});
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

TEST_F(PoseGuideTest, TellsWhatIsToBeMeasuredThere) {
  guide_.receive(joints(0.11, 0.0, -1.01));
  EXPECT_EQ(guide_.here(), 0U);
  EXPECT_EQ(guide_.missing(0), (Coils{0, 2, 5}));
  EXPECT_EQ(guide_.advice(),
            "Pose 1 of 2: there. Clamp the rotor, then measure; it excites coil 2, 5 in turn.");
}

TEST_F(PoseGuideTest, GoesOnWhenAllIsMeasured) {
  guide_.receive(sample(0.1, 0.0, -1.0, {0.0, 0.01, 0.0, 0.0, 0.0}));
  guide_.receive(sample(0.1, 0.0, -1.0, {0.0, 2.0, 0.0, 0.0, 0.0}));
  // Several coils, and another pose.
  guide_.receive(sample(0.1, 0.0, -1.0, {0.0, 2.0, 0.0, 0.0, 2.0}));
  guide_.receive(sample(0.2, 0.0, -1.0, {0.0, 0.0, 0.0, 0.0, 2.0}));
  EXPECT_EQ(guide_.missing(0), (Coils{5}));
  // The opposite current tells the same.
  guide_.receive(sample(0.1, 0.0, -1.0, {0.0, 0.0, 0.0, 0.0, -2.0}));
  EXPECT_EQ(guide_.next(), 1U);
  guide_.receive(joints(0.3, 0.2, 1.0));
  EXPECT_EQ(guide_.advice(), "Pose 2 of 2: there. Clamp the rotor, then measure.");
  guide_.receive(sample(0.3, 0.2, 1.0, {0.0, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(guide_.next());
  EXPECT_EQ(guide_.advice(), "All 2 poses are measured: calibrate.");
}

TEST_F(PoseGuideTest, GoesOnWhereAnotherSaysThatAllIsHeld) {
  guide_.noteMeasured(0);
  EXPECT_TRUE(guide_.missing(0).empty());
  EXPECT_EQ(guide_.next(), 1U);
}

TEST_F(PoseGuideTest, MeetsAPoseAsNearAsTheNodeSays) {
  guide_.receive(joints(0.14, -0.04, -1.04));
  EXPECT_EQ(guide_.here(), 0U);
  guide_.receive(joints(0.16, 0.0, -1.0));
  EXPECT_FALSE(guide_.here());
  EXPECT_EQ(guide_.advice(), "Pose 1 of 2: turn joint_1 by −3.4°.");
  guide_.judgeBy(0.07, 0.1);
  EXPECT_EQ(guide_.here(), 0U);
}

// As the node counts: without its sample without current a pose is measured all the same.
TEST_F(PoseGuideTest, NeedsEachCoilAndAnySample) {
  guide_.receive(sample(0.1, 0.0, -1.0, {0.0, 2.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(guide_.missing(0), (Coils{0, 5}));
  guide_.receive(sample(0.1, 0.0, -1.0, {0.0, 0.0, 0.0, 0.0, 2.0}));
  EXPECT_EQ(guide_.missing(0), Coils());
  guide_.receive(sample(0.3, 0.2, 1.0, {2.0, 2.0, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(guide_.next());
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
  guide_.take({planned(0.3, 0.2, 3.0, {})});
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
  guide_.judgeBy(0.3, 0.1);
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
