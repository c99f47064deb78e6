#include "spherical_actuator_calibration/streams/orientation_jump_filter.hpp"

namespace sac {

bool OrientationJumpFilter::judge(Stamp stamp, const Eigen::Quaterniond& q_stator_rotor) {
  const Place place{stamp, q_stator_rotor};
  if (!known_ || follows(place, last_)) {
    known_ = true;
    last_ = place;
    suspects_ = 0;
    return true;
  }
  suspects_ = suspects_ > 0 && follows(place, suspect_) ? suspects_ + 1 : 1;
  suspect_ = place;
  if (suspects_ < limits_.confirmations) {
    return false;
  }
  last_ = place;
  suspects_ = 0;
  return true;
}

void OrientationJumpFilter::restart() {
  known_ = false;
  suspects_ = 0;
}

bool OrientationJumpFilter::follows(const Place& place, const Place& before) const {
  const double angle = before.q_stator_rotor.angularDistance(place.q_stator_rotor);
  const double duration = secondsBetween(before.stamp, place.stamp);
  return angle <= limits_.tolerance + limits_.largest_rate * duration;
}

}  // namespace sac
