#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// What the data of a problem leave open, and how it is held at the prior.
struct UnidentifiedPart {
  /// Coordinates that are held whole, ascending.
  std::vector<Eigen::Index> coordinates;
  /// P×d, orthonormal columns that are zero in `coordinates`: directions of which only the
  /// component along them is held. The data tell the rest of the coordinates that they span.
  Eigen::MatrixXd directions;
};

/// Judges the information matrix (F×F) of the coordinates `free` (ascending): a standard deviation
/// above `limit` [rad] is open.
///
/// A laboratory effect that takes part in an open direction is held first: it was an option. One of
/// which something is stated is not: it is known by that, however coarsely, and no direction that
/// is held has a part in it. Then coordinates are held whole that the data leave open by
/// themselves, as those of a pole that no sample sees. Of all others only the open directions are
/// held: two parallel joints have offsets whose sum the data tell though not their difference, and
/// torques alone leave open how the stator is turned as a whole (doc/method.md, Gauge). Held whole,
/// the prior of such coordinates would count as noise of each sample by itself, and hide every
/// misfit.
UnidentifiedPart unidentifiedPart(const Eigen::MatrixXd& information,
                                  const std::vector<Eigen::Index>& free,
                                  const ParameterSpace& space,
                                  double limit);

}  // namespace sac
