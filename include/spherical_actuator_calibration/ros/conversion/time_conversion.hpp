#pragma once

#include <ros/time.h>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// The core's stamp [ns since the epoch of the ROS clock] of a ROS time. Exact.
Stamp stampFromRos(const ros::Time& time);

/// The ROS time of a stamp of the core [ns]. Exact. Throws DataError when the stamp is negative or
/// does not fit into ROS's 32 bits of seconds.
ros::Time stampToRos(Stamp stamp);

/// From one time to another [s], negative when the second is the earlier one. ros::Duration throws
/// where they are 68 years apart, as a stamp of the year 2106 is.
double secondsBetween(const ros::Time& from, const ros::Time& to);

/// The time in the middle between two.
ros::Time middleOf(const ros::Time& begin, const ros::Time& end);

/// The time so many seconds before another, at the earliest that of a clock at zero, as a simulated
/// one that was not heard yet. Precondition: seconds ≥ 0.
ros::Time timeBefore(const ros::Time& time, double seconds);

}  // namespace sac
