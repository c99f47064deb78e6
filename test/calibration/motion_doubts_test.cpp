#include "motion_doubts.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

/// The only doubt, which has to say this.
void expectOne(const MotionEstimate& found, const std::string& part) {
  const std::vector<std::string> doubts = motionDoubts(found, {});
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_NE(doubts[0].find(part), std::string::npos) << doubts[0];
}

TEST(MotionDoubts, AreNoneOfNoiseAsItIsStated) {
  MotionEstimate found;
  EXPECT_TRUE(motionDoubts(found, {}).empty());
  found.alignment = {1.15, 0.05};
  EXPECT_TRUE(motionDoubts(found, {}).empty());
}

TEST(MotionDoubts, SayWhatToDoWhereResidualsLeanOnTheParameters) {
  MotionEstimate found;
  found.alignment = {1.44, 0.05};
  expectOne(found, "moves the parameters 1.20 times as far");
  expectOne(found, "(told from 1.10 times on)");
  expectOne(found, "Record coil_command");
}

TEST(MotionDoubts, SayThatTheTrackersNoiseIsNotWhite) {
  MotionEstimate found;
  found.tracker_colour = 9.0;
  found.summary.orientation_stddev = 3e-3;
  expectOne(found, "3.0 times as far off as white noise of 1 mrad");
  expectOne(found, "look for a filter or a vibration of the tracker");
}

}  // namespace
}  // namespace sac
