#pragma once

#include <cstdint>

namespace sac {

/// Most that a peer of ROS may announce [byte]. The longest message of a laboratory, a report of
/// 400 coils, has less than 1 MB. Nodes in Python have the same (bounded_links.py).
inline constexpr std::uint32_t kLongestMessage = 16U << 20U;
inline constexpr std::uint32_t kLongestHeader = 1U << 20U;

}  // namespace sac
