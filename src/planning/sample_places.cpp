#include "spherical_actuator_calibration/planning/sample_places.hpp"

#include <algorithm>
#include <iterator>

#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

namespace sac {

std::size_t SamplePlaces::placeOf(const Sample& sample) {
  const auto known = std::find_if(places_.begin(), places_.end(), [&](const Place& place) {
    return place.validation == sample.validation && isAtPose(sample, place.joint_position);
  });
  const auto number = static_cast<std::size_t>(std::distance(places_.begin(), known));
  if (known == places_.end()) {
    places_.push_back({sample.joint_position, sample.validation});
  }
  return number;
}

}  // namespace sac
