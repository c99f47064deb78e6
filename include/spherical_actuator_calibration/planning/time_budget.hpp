#pragma once

#include <functional>

namespace sac {

/// Whether so many seconds [s] have passed since this call, for PosePlanOptions::is_time_up; an
/// empty function for 0. Throws ConfigError for what is no length of time.
std::function<bool()> timeIsUpAfter(double seconds);

}  // namespace sac
