#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace sac {

/// Length of one move [rad]: the largest angle of any joint, for the joints move together.
double moveLength(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Length of the moves from `start` through all poses in the given order [rad].
double travelLength(const Eigen::Vector3d& start,
                    const std::vector<Eigen::Vector3d>& poses,
                    const std::vector<std::size_t>& order);

/// Order in which to visit the poses (joint angles [rad]) from `start`, not coming back, for a
/// short way: from a first pose always to the nearest, then reversing and shifting parts of the
/// way as long as that shortens it; the best over several first poses.
std::vector<std::size_t> travelOrder(const Eigen::Vector3d& start,
                                     const std::vector<Eigen::Vector3d>& poses);

}  // namespace sac
