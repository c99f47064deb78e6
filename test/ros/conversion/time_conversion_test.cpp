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

}  // namespace
}  // namespace sac
