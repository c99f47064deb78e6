#pragma once

namespace sac {

/// By which tests let emulated time pass [s].
inline constexpr double kTimeStep = 1e-3;

}  // namespace sac
