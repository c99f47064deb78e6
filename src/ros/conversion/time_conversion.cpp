#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

#include <cstdint>
#include <limits>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr Stamp kTicksPerSecond = 1'000'000'000;

}  // namespace

Stamp stampFromRos(const ros::Time& time) {
  return static_cast<Stamp>(time.sec) * kTicksPerSecond + static_cast<Stamp>(time.nsec);
}

ros::Time stampToRos(Stamp stamp) {
  const Stamp seconds = stamp / kTicksPerSecond;
  if (stamp < 0 || seconds > std::numeric_limits<std::uint32_t>::max()) {
    throw DataError("The stamp " + std::to_string(stamp) +
                    " ns cannot be written as ROS time: check the clock that made it.");
  }
  return {static_cast<std::uint32_t>(seconds), static_cast<std::uint32_t>(stamp % kTicksPerSecond)};
}

double secondsBetween(const ros::Time& from, const ros::Time& to) {
  // Both are less than 2^32 s, which 64 bits of ticks hold twice.
  return static_cast<double>(stampFromRos(to) - stampFromRos(from)) /
         static_cast<double>(kTicksPerSecond);
}

ros::Time middleOf(const ros::Time& begin, const ros::Time& end) {
  const Stamp first = stampFromRos(begin);
  return stampToRos(first + (stampFromRos(end) - first) / 2);
}

ros::Time timeBefore(const ros::Time& time, double seconds) {
  const double ticks = seconds * static_cast<double>(kTicksPerSecond);
  const Stamp stamp = stampFromRos(time);
  return ticks < static_cast<double>(stamp) ? stampToRos(stamp - static_cast<Stamp>(ticks))
                                            : ros::Time();
}

}  // namespace sac
