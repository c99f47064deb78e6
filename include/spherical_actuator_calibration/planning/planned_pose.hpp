#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

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

/// One pose to measure at, and what to excite there (message PlannedPose).
struct PlannedPose {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles q [rad]
  std::vector<std::size_t> coils;     ///< that are excited, ascending; none: orientation only
  std::vector<CoilPattern> patterns;  ///< in turn; none: each of the coils alone

  /// The patterns, also where each coil is alone.
  std::vector<CoilPattern> excitations() const;
};

}  // namespace sac
