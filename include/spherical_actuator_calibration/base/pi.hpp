#pragma once

namespace sac {

/// π to the last bit of a double.
inline constexpr double kPi = 3.14159265358979323846;
/// One degree [rad].
inline constexpr double kOneDegree = kPi / 180.0;

}  // namespace sac
