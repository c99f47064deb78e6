#include "spherical_actuator_calibration/calibration/motion_follower.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/motion_slices.hpp"
#include "support/moving_rotor.hpp"

namespace sac {
namespace {

/// Lets a follower see a motion as it comes; its groups after every window.
std::vector<std::vector<GroupUncertainty>> follow(
    const MotionStreams& streams, MotionFollower& follower, const std::function<void()>& look = [] {
    }) {
  std::vector<std::vector<GroupUncertainty>> told;
  for (MotionSlice& slice : slicesOf(streams)) {
    follower.add(std::move(slice));
    told.push_back(follower.groups());
    look();
  }
  return told;
}

TEST(MotionFollower, TellsEachGroupBetterAndBetter) {
  scenarios::Generator generator(3);
  MovingRotor moving;
  moving.truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
  moving.rotor.unbalance = Eigen::Vector3d(1e-3, -5e-4, 2e-3);
  moving.duration = 9.0;
  constexpr double kWanted = 1e-4;  // [rad]
  MotionFollower follower(scenarios::paperNominal(), CalibrationConfig(), kWanted);
  EXPECT_FALSE(follower.timeLeft());
  const auto told = follow(moving.record().spans.front(), follower);
  ASSERT_TRUE(follower.estimate().is_told);
  ASSERT_EQ(told.front().size(), 3U);
  const std::vector<std::string> groups = {"joints", "poles", "coils"};
  const std::vector<std::size_t> parameters = {9, 16, 48};
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(told.front()[n].group, groups[n]);
    // As uncertain as it was made.
    EXPECT_GT(told.front()[n].stddev, 5e-3);
    EXPECT_LT(told.back()[n].stddev, 1e-3);
    EXPECT_EQ(told.front()[n].left, told.front()[n].parameters);
    EXPECT_EQ(told.back()[n].parameters, parameters[n]);
    EXPECT_EQ(told.back()[n].left == 0, told.back()[n].stddev <= kWanted);
  }
  EXPECT_EQ(told.back()[2].least_known.rfind("coil_", 0), 0U) << told.back()[2].least_known;
  const std::vector<ParameterEstimate> dynamics = follower.dynamics();
  const auto unbalance = std::find_if(dynamics.begin(), dynamics.end(), [](const auto& one) {
    return one.name == "rotor_unbalance/z";
  });
  ASSERT_NE(unbalance, dynamics.end());
  EXPECT_NEAR(unbalance->value, 2e-3, 1e-4);
  EXPECT_TRUE(unbalance->observable);
}

/// The worst standard deviation of all.
double worst(const MotionFollower& follower) {
  double most = 0.0;
  for (const GroupUncertainty& one : follower.groups()) {
    most = std::max(most, one.stddev);
  }
  return most;
}

TEST(MotionFollower, TellsHowLongItTakes) {
  scenarios::Generator generator(3);
  MovingRotor moving;
  moving.truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
  moving.duration = 9.0;
  const MotionStreams streams = moving.record().spans.front();
  MotionFollower once(scenarios::paperNominal(), CalibrationConfig(), 1e-4);
  follow(streams, once);
  // Half of what is there takes four times as long.
  MotionFollower finer(scenarios::paperNominal(), CalibrationConfig(), 0.5 * worst(once));
  follow(streams, finer);
  EXPECT_NEAR(finer.timeLeft().value(), 3.0 * finer.estimate().duration, 1e-6);
  MotionFollower coarser(scenarios::paperNominal(), CalibrationConfig(), 2.0 * worst(once));
  follow(streams, coarser);
  EXPECT_EQ(coarser.timeLeft(), 0.0);
  // Nothing judges it yet.
  EXPECT_FALSE(coarser.isEnough());
}

TEST(MotionFollower, TellsWhetherSomeWindowsCanJudge) {
  scenarios::Generator generator(3);
  MovingRotor moving;
  moving.truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
  moving.duration = 30.0;
  constexpr double kSomewhatMore = 3.5e-8;  // than streams without noise tell at the end [rad]
  MotionFollower follower(scenarios::paperNominal(), CalibrationConfig(), kSomewhatMore);
  std::size_t first = 0;  // with which it can
  bool is_ever_enough = false;
  bool is_ever_judged_only = false;
  follow(moving.record().spans.front(), follower, [&] {
    const LiveEstimate& estimate = follower.estimate();
    const bool suffices = estimate.windows - estimate.left_out >= 48;
    EXPECT_EQ(follower.canBeJudged(), suffices) << estimate.windows;
    EXPECT_EQ(follower.isEnough(), suffices && worst(follower) <= follower.wantedStddev());
    is_ever_enough |= follower.isEnough();
    is_ever_judged_only |= suffices && !follower.isEnough();
    first = first == 0 && suffices ? estimate.windows : first;
  });
  // More than a calibration of the same windows wants: the recording may have fewer.
  EXPECT_GT(first, MotionOptions().least_windows_to_hold_out) << follower.estimate().windows;
  EXPECT_TRUE(is_ever_enough && is_ever_judged_only) << worst(follower);
}

TEST(MotionFollower, SuitsActuatorsWithJointsAndTorqueModel) {
  Actuator actuator = scenarios::paperNominal();
  EXPECT_TRUE(MotionFollower::suits(actuator));
  actuator.has_joints = false;
  EXPECT_FALSE(MotionFollower::suits(actuator));
  actuator.has_joints = true;
  actuator.poles.clear();
  EXPECT_FALSE(MotionFollower::suits(actuator));
}

}  // namespace
}  // namespace sac
