#pragma once

#include <ros/time.h>

namespace sac {

/// Now by the wall clock, even where /use_sim_time is set: the stamp of commands to devices, which
/// are real and know no other time.
ros::Time wallStamp();

}  // namespace sac
