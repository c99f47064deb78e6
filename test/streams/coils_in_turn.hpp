#pragma once

#include <cstddef>

namespace sac {

/// Of scripts in which single coils are excited in turn.
inline constexpr std::size_t kCoilsInTurn = 3;

}  // namespace sac
