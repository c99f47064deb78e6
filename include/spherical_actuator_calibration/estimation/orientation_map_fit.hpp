#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/orientation_map.hpp"

namespace sac {

/// What poses show beside axes, offsets and corrections.
struct UnexplainedRotations {
  std::vector<Eigen::Vector3d> readings;  ///< raw sensor angles [rad]
  std::vector<Eigen::Vector3d>
      rotations;  ///< R_measured = e^{rotation} R_model, stator frame [rad]
  /// Of each component of each rotation, by the tracker as stated [rad²]. Empty: not known.
  std::vector<double> tracker_variances;
};

/// One entry for each pose: readings that differ by less than a milliradian are averaged.
UnexplainedRotations mergedPoses(const UnexplainedRotations& all);

/// A map and what speaks for it.
struct OrientationMapFit {
  OrientationMapDescription map;
  /// Log likelihood of the rotations by the map less that of white noise alone, each at its best
  /// hyperparameters [nats].
  double gain = 0.0;
};

/// Finds lengths, amplitudes and noises by the largest marginal likelihood of the rotations, with a
/// wide log-normal prior of the lengths; a joint that hardly moves has the prior's length
/// (doc/method.md, Residual map). With `start`, the search begins at its lengths, and is short. At
/// most kMostMapPoints rotations are used, and 150 of them for lengths, amplitudes and noises; they
/// are chosen evenly. The tracker's part of the noise is what it states, unless the poses differ by
/// less than 0.7 of that: it is not known then. Precondition: at least one rotation.
OrientationMapFit fitOrientationMap(const UnexplainedRotations& poses,
                                    const OrientationMapDescription* start = nullptr);

}  // namespace sac
