#include "spherical_actuator_calibration/emulation/session_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

Eigen::Vector3d firstPose() {
  return {0.1, -0.2, 0.4};
}

Eigen::Vector3d secondPose() {
  return {-0.3, 0.2, 3.0};
}

/// One pose without current, one with two patterns.
SessionPlan twoDwells() {
  SessionPlan plan;
  plan.dwells.push_back({firstPose(), {}});
  plan.dwells.push_back({secondPose(), {Eigen::Vector2d(2.0, 0.0), Eigen::Vector2d(0.0, -1.0)}});
  return plan;
}

TEST(SessionTrajectory, RestsAtEachDwellForItsTime) {
  SessionTrajectory trajectory(twoDwells(), {}, 2);
  ASSERT_EQ(trajectory.dwells().size(), 2U);
  const DwellTimes first = trajectory.dwells()[0];
  const DwellTimes second = trajectory.dwells()[1];
  EXPECT_NEAR(first.begin, 0.8, 1e-12);
  EXPECT_NEAR(first.end - first.begin, 0.3 + 0.6 + 0.3, 1e-12);
  EXPECT_NEAR(second.end - second.begin, 0.3 + 0.4 + 2 * 0.6 + 0.3, 1e-12);
  EXPECT_EQ(trajectory.duration(), second.end);
  EXPECT_EQ(trajectory.at(0.0).joint_position, Eigen::Vector3d::Zero().eval());
  for (const double time : {first.begin, first.end - 1e-9}) {
    EXPECT_EQ(trajectory.at(time).joint_position, firstPose());
    EXPECT_EQ(trajectory.at(time).dwell, std::size_t{0});
  }
  EXPECT_FALSE(trajectory.at(0.5 * (first.end + second.begin)).dwell.has_value());
  EXPECT_EQ(trajectory.at(second.begin + 1e-9).joint_position, secondPose());
  EXPECT_EQ(trajectory.at(trajectory.duration() + 5.0).joint_position, secondPose());
}

TEST(SessionTrajectory, MovesSmoothlyWithinTheSpeed) {
  SessionTiming timing;
  timing.peak_joint_speed = 2.0;
  SessionTrajectory trajectory(twoDwells(), timing, 2);
  constexpr double kStep = 1e-4;
  double peak = 0.0;
  Eigen::Vector3d previous = trajectory.at(0.0).joint_position;
  double previous_speed = 0.0;
  double largest_jump = 0.0;
  for (double time = kStep; time < trajectory.duration(); time += kStep) {
    const Eigen::Vector3d position = trajectory.at(time).joint_position;
    const double speed = (position - previous).cwiseAbs().maxCoeff() / kStep;
    largest_jump = std::max(largest_jump, std::abs(speed - previous_speed));
    peak = std::max(peak, speed);
    previous = position;
    previous_speed = speed;
  }
  EXPECT_NEAR(peak, 2.0, 1e-3);
  EXPECT_LT(largest_jump, 2e-3);
}

TEST(SessionTrajectory, CurrentsFollowWithTheAmplifiersLag) {
  SessionTrajectory trajectory(twoDwells(), {}, 2);
  const double on = trajectory.dwells()[1].begin + 0.3 + 0.4;
  EXPECT_EQ(trajectory.at(on - 1e-6).current, Eigen::VectorXd::Zero(2));
  EXPECT_NEAR(trajectory.at(on + 0.005).current[0], 2.0 * (1.0 - std::exp(-1.0)), 1e-9);
  EXPECT_EQ(trajectory.at(on + 0.5).current, Eigen::VectorXd(Eigen::Vector2d(2.0, 0.0)));
  const Eigen::VectorXd changing = trajectory.at(on + 0.6 + 0.005).current;
  EXPECT_NEAR(changing[0], 2.0 * std::exp(-1.0), 1e-9);
  EXPECT_NEAR(changing[1], std::exp(-1.0) - 1.0, 1e-9);
  EXPECT_EQ(trajectory.at(trajectory.duration()).current, Eigen::VectorXd::Zero(2));
}

TEST(SessionTrajectory, RefusesTimesThatCannotBe) {
  SessionTiming timing;
  timing.pattern = 0.0;
  EXPECT_THROW(SessionTrajectory(twoDwells(), timing, 2), ConfigError);
  EXPECT_THROW(SessionTrajectory(twoDwells(), {}, 3), ConfigError);
}

}  // namespace
}  // namespace sac
