#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace sac {

// Poles, coils and joints count from 0 inside, and from 1 in words, messages and files. This is the
// one place that knows.

/// The number that people see.
constexpr std::size_t numberOf(std::size_t index) {
  return index + 1;
}

/// The same where there may be none; 0 stands for none.
constexpr std::uint32_t numberOrZero(const std::optional<std::size_t>& index) {
  return index ? static_cast<std::uint32_t>(numberOf(*index)) : 0U;
}

/// Inverse of numberOrZero(): nothing for 0.
constexpr std::optional<std::size_t> indexOf(std::size_t number) {
  return number == 0 ? std::nullopt : std::optional<std::size_t>(number - 1);
}

}  // namespace sac
