#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

namespace sac {

/// The first coil, counted from 0, that does not carry what it is commanded; nothing where all do.
/// Both [A], one per coil, as many in both. `current_threshold` [A]: see currentTolerance().
std::optional<std::size_t> coilAmiss(const Eigen::VectorXd& commanded,
                                     const Eigen::VectorXd& measured,
                                     double current_threshold);

}  // namespace sac
