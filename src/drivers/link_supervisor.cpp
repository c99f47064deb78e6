#include "spherical_actuator_calibration/drivers/link_supervisor.hpp"

#include <algorithm>

namespace sac {

void LinkSupervisor::success() {
  if (!is_up_ && was_up_) {
    ++reconnects_;
  }
  is_up_ = true;
  was_up_ = true;
  wait_ = 0.0;
}

void LinkSupervisor::failure(double now, const std::string& reason) {
  is_up_ = false;
  ++failures_;
  last_error_ = reason;
  wait_ = wait_ == 0.0 ? back_off_.first : std::min(2.0 * wait_, back_off_.largest);
  next_try_ = now + wait_;
}

}  // namespace sac
