#pragma once

namespace sac {

/// A coil with less counts as one without current [A].
inline constexpr double kThreshold = 0.05;

}  // namespace sac
