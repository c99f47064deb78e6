#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "support/synthetic_streams.hpp"

namespace sac {

/// Where scripts of one dwell let the rotor rest.
inline const Eigen::Vector3d rest_pose(0.3, -0.2, 1.0);
/// Of scripts with two patterns.
inline constexpr std::size_t kCoils = 4;

/// Arrives, two patterns after a part without current, leaves.
inline synthetic::Script twoPatterns(const Eigen::Vector3d& place = rest_pose) {
  return synthetic::Script(kCoils)
      .moveTo(place)
      .rest(0.8)
      .excite(0, 2.0, 0.8)
      .excite(2, -1.5, 0.8)
      .rest(0.5)
      .moveTo(-place);
}

}  // namespace sac
