#include "held_out_outliers.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kRateInUse = 0.01;  // of outliers
constexpr double kMost = 0.3;

/// Twenty torques of the coils 0 to 4 in turn; n is that of coil n % 5, at the place 100 + n.
std::vector<HeldOutMeasurement> torques() {
  std::vector<HeldOutMeasurement> measurements(20);
  for (std::size_t n = 0; n < measurements.size(); ++n) {
    measurements[n].quantity = Quantity::kTorque;
    measurements[n].sample = 100 + n;
    measurements[n].counts = true;
    measurements[n].coils = {n % 5};
  }
  return measurements;
}

OutlierChoice choose(const std::vector<std::size_t>& standing_out,
                     const std::map<std::size_t, TorquesInUse>& in_use = {},
                     double rate = kRateInUse) {
  return chooseOutliers(torques(), standing_out, in_use, rate, kMost);
}

TEST(HeldOutOutliers, AreSetAsideWhereOthersOfTheirCoilsFollow) {
  const OutlierChoice choice = choose({3, 6});
  EXPECT_EQ(choice.count, 2U);
  EXPECT_TRUE(choice.set_aside[3] && choice.set_aside[6]);
  EXPECT_TRUE(choice.undecided_coils.empty());
  EXPECT_TRUE(choice.doubtful_coils.empty());
}

TEST(HeldOutOutliers, AreNoneWhereThereAreMoreThanElsewhere) {
  EXPECT_EQ(choose({3, 6, 9, 11}).count, 0U);
  EXPECT_EQ(choose({3}, {}, 0.0).count, 0U);
}

TEST(HeldOutOutliers, MakeTheNewestTorqueOfACoilDoubtful) {
  const OutlierChoice choice = choose({17});
  EXPECT_EQ(choice.count, 1U);
  EXPECT_EQ(choice.doubtful_coils, std::vector<std::size_t>{2});
  EXPECT_TRUE(choice.undecided_coils.empty());
}

TEST(HeldOutOutliers, AreNoneWhereTheNewestOfACoilAreTwo) {
  EXPECT_EQ(choose({12, 17}).count, 0U);
  EXPECT_EQ(choose({12, 17}).changed_coils.at(2), (std::vector<std::size_t>{12, 17}));
  // With one between them that agrees, they are accidents.
  EXPECT_EQ(choose({7, 17}).count, 2U);
}

TEST(HeldOutOutliers, CountWithThoseInUse) {
  std::map<std::size_t, TorquesInUse> in_use;
  in_use[2].last_agreeing = 50;
  in_use[2].rejected = {40, 115};
  EXPECT_EQ(choose({17}, in_use).count, 0U);
  // What agreed since says that they were accidents.
  in_use[2].last_agreeing = 130;
  const OutlierChoice choice = choose({17}, in_use);
  EXPECT_EQ(choice.count, 1U);
  EXPECT_TRUE(choice.doubtful_coils.empty());
}

TEST(HeldOutOutliers, LeaveACoilUndecidedOfWhichNothingElseTells) {
  std::vector<HeldOutMeasurement> measurements = torques();
  for (const std::size_t n : {2U, 7U, 12U}) {
    measurements[n].counts = false;
  }
  const OutlierChoice choice = chooseOutliers(measurements, {17}, {}, kRateInUse, kMost);
  EXPECT_EQ(choice.undecided_coils, std::vector<std::size_t>{2});
}

}  // namespace
}  // namespace sac
