#pragma once

#include <Eigen/Core>

namespace sac {

/// Lower triangular, with three scales.
inline Eigen::Matrix3d someWhitening() {
  return (Eigen::Matrix3d() << 1.0, 0.0, 0.0, 0.3, 2.0, 0.0, -0.2, 0.1, 0.7).finished();
}

}  // namespace sac
