#pragma once

namespace sac {

/// Of simulated sensors: uniform within ± these, per component.
inline constexpr double kOrientationNoise = 1e-3;  // [rad]
inline constexpr double kTorqueNoise = 5e-4;       // [N·m]

}  // namespace sac
