#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sac {

/// A coil of a pattern, counted from 0, and the way of its current: +1 or −1.
struct SignedCoil {
  std::size_t coil = 0;
  int sign = 1;

  friend bool operator==(const SignedCoil& a, const SignedCoil& b) {
    return a.coil == b.coil && a.sign == b.sign;
  }
};

/// Coils that are excited together for one torque, ascending.
using CoilPattern = std::vector<SignedCoil>;

/// "+1 -4": coil 1 at +current and coil 4 at −current, counted from 1.
std::string patternText(const CoilPattern& pattern);

/// Each of the coils alone.
std::vector<CoilPattern> singly(const std::vector<std::size_t>& coils);

}  // namespace sac
