#pragma once

#include <limits>

namespace sac {

/// What a measurement is that its device does not have.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace sac
