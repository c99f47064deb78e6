#include "motion_words.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

class MotionWords : public ::testing::Test {
 protected:
  MotionWords() {
    estimate_.is_told = true;
    estimate_.windows = 51;
    estimate_.duration = 12.3;
  }

  std::string words(std::optional<double> time_left = std::nullopt) const {
    return motionInWords(estimate_, groups_, 1e-4, can_be_judged_, time_left);
  }

  bool can_be_judged_ = true;
  LiveEstimate estimate_;
  std::vector<GroupUncertainty> groups_ = {{"joints", "joint_3/offset", 5e-5, 9, 0},
                                           {"poles", "pole_2/polar", 2e-4, 16, 1},
                                           {"coils", "coil_7/azimuth", 3e-4, 48, 30}};
};

TEST_F(MotionWords, NameWhatIsLeft) {
  EXPECT_EQ(words(95.6),
            "12 s of motion: joints 0.050, poles 0.200, coils 0.300 mrad; left to 0.100 mrad: 1 "
            "of 16 poles (pole_2/polar), 30 of 48 coils (coil_7/azimuth), some 96 s more.");
  EXPECT_EQ(words().substr(words().size() - 18), " (coil_7/azimuth).");
}

TEST_F(MotionWords, TellThatNothingIsLeft) {
  groups_.resize(1);
  estimate_.left_out = 3;
  EXPECT_EQ(words(0.0),
            "12 s of motion: joints 0.050 mrad, 3 of 51 windows left out; all within 0.100 mrad.");
  can_be_judged_ = false;
  EXPECT_NE(words(0.0).find("within 0.100 mrad, by too few windows"), std::string::npos);
}

TEST_F(MotionWords, TellThatNothingIsKnownYet) {
  estimate_.is_told = false;
  EXPECT_EQ(words(), "51 windows of motion: the first estimate is to come.");
  estimate_.windows = 0;
  EXPECT_EQ(words().substr(0, 14), "No motion yet:");
}

}  // namespace
}  // namespace sac
