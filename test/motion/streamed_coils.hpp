#pragma once

#include <cstddef>

namespace sac {

/// Coils whose currents tests give measurement by measurement.
inline constexpr std::size_t kCoils = 2;

}  // namespace sac
