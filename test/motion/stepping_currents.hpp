#pragma once

namespace sac {

/// Currents that follow setpoints in steps, with a lag [s].
inline constexpr double kLag = 2e-3;   // of currents behind their setpoints
inline constexpr double kHold = 5e-3;  // from one setpoint to the next
inline constexpr double kDuration = 20.0;

}  // namespace sac
