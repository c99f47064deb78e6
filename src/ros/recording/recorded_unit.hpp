#pragma once

#include <string>

#include <ros/serialization.h>
#include <std_msgs/Header.h>

namespace sac {

/// Whose recording it is: what ActuatorParameters begins with, in every release. What follows there
/// differs from release to release.
struct RecordedUnit {
  std_msgs::Header header;
  std::string actuator;
  std::string serial;
};

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
