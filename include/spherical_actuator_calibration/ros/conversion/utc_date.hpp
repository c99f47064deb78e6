#pragma once

#include <string>

namespace sac {

/// Date and time by the clock of this machine, in UTC: 2024-05-31T12:00:00Z.
std::string utcDate();

}  // namespace sac
