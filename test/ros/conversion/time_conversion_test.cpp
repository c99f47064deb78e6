#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>
#include <ros/time.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr std::uint32_t kLastSecond = std::numeric_limits<std::uint32_t>::max();

TEST(TimeConversion, KeepsEveryNanosecond) {
  EXPECT_EQ(stampFromRos(ros::Time(1'700'000'000, 123'456'789)), 1'700'000'000'123'456'789);
  EXPECT_EQ(stampToRos(1'700'000'000'123'456'789), ros::Time(1'700'000'000, 123'456'789));
}

TEST(TimeConversion, CoversTheRangeOfRosTime) {
  for (const ros::Time& time : {ros::Time(0, 0), ros::Time(kLastSecond, 999'999'999)}) {
    EXPECT_EQ(stampToRos(stampFromRos(time)), time);
  }
}

TEST(TimeConversion, RefusesStampsOutsideRosTime) {
  EXPECT_THROW(stampToRos(-1), DataError);
  EXPECT_THROW(stampToRos((Stamp{kLastSecond} + 1) * 1'000'000'000), DataError);
}

// The clock of a computer without battery, or one set to the year 2106: ros::Duration throws.
TEST(TimeConversion, HoldsEveryDifference) {
  const ros::Time first(0, 1);
  const ros::Time last(kLastSecond, 999'999'999);
  EXPECT_DOUBLE_EQ(secondsBetween(first, last), 4294967296.0 - 2e-9);
  EXPECT_DOUBLE_EQ(secondsBetween(last, first), -4294967296.0 + 2e-9);
  EXPECT_DOUBLE_EQ(secondsBetween(ros::Time(1.0), ros::Time(1.5)), 0.5);
  EXPECT_EQ(middleOf(first, last), ros::Time(2147483648, 0));
  EXPECT_EQ(middleOf(ros::Time(2.0), ros::Time(1.0)), ros::Time(1.5));
}

TEST(TimeConversion, GoesBackUntilZero) {
  EXPECT_EQ(timeBefore(ros::Time(5, 250'000'000), 0.5), ros::Time(4, 750'000'000));
  EXPECT_EQ(timeBefore(ros::Time(5.0), 0.0), ros::Time(5.0));
  EXPECT_EQ(timeBefore(ros::Time(0.1), 0.5), ros::Time());
  EXPECT_EQ(timeBefore(ros::Time(), 1e12), ros::Time());
}

}  // namespace
}  // namespace sac
