#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace sac {

/// The 24 rotations of the cube, the identity first: axes of two frames that somebody mixed up.
std::vector<Eigen::Matrix3d> cubeRotations();

/// "90 deg about z", "120 deg about (1, 1, -1)", "37.5 deg about (0.27, 0.53, 0.80)".
std::string rotationInWords(const Eigen::Matrix3d& rotation);

}  // namespace sac
