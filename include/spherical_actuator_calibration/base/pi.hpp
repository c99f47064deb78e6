#pragma once

namespace sac {

/// π to the last bit of a double.
inline constexpr double kPi = 3.14159265358979323846;

}  // namespace sac
