#include "spherical_actuator_calibration/streams/arrival_watch.hpp"

#include <algorithm>

namespace sac {

bool ArrivalWatch::look(std::uint64_t received, double now) {
  const bool has_arrived = received != received_;
  received_ = received;
  silence_ = has_arrived ? 0.0 : silence_ + std::clamp(now - last_look_, 0.0, kLongestStep);
  last_look_ = now;
  return has_arrived;
}

}  // namespace sac
