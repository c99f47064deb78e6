#pragma once

#include <string>

#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// Whose recording it is: what ActuatorParameters begins with, in every release. What follows there
/// differs from release to release.
struct RecordedUnit {
  std_msgs::Header header;
  std::string actuator;
  std::string serial;
};

/// Throws DataError, naming the recording, where it is of another unit than an actuator.
void requireSameUnit(const std::string& recording,
                     const RecordedUnit& unit,
                     const Actuator& actuator);

}  // namespace sac

namespace ros::serialization {

template <>
struct Serializer<sac::RecordedUnit> {
  template <typename Stream>
  static void read(Stream& stream, sac::RecordedUnit& unit) {
    stream.next(unit.header);
    stream.next(unit.actuator);
    stream.next(unit.serial);
  }
};

}  // namespace ros::serialization
