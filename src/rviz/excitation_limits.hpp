#pragma once

namespace sac {

/// What the panel offers; the coil driver and the engine have limits of their own.
inline constexpr double kLargestCurrent = 100.0;    ///< [A]
inline constexpr double kOfferedCurrent = 2.0;      ///< of a coil [A]: kUsualExcitation
inline constexpr double kShortestExcitation = 0.5;  ///< [s]

}  // namespace sac
