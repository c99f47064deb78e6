#include "spherical_actuator_calibration/ros/node/wall_stamp.hpp"

namespace sac {

ros::Time wallStamp() {
  const ros::WallTime now = ros::WallTime::now();
  return {now.sec, now.nsec};
}

}  // namespace sac
