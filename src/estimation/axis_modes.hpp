#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/manufacturing_tolerance.hpp"
#include "weighted_observations.hpp"

namespace sac {

/// A place of one pole or coil axis where its torques fit as they do nowhere near.
struct AxisMode {
  Eigen::Index first = 0;  ///< coordinate u of the axis, v follows
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  /// By how much the robust misfit of the axis's torques, and of its distance from the drawing
  /// (in tolerances, or in the scatter of the unit's axes where that is larger), is smaller there
  /// than at the present place; negative where it is larger.
  double gain = 0.0;
};

/// Where and how otherModes() looks.
struct ModeSearch {
  double range = 0.0;       ///< half width of the scan around the nominal axis [rad]
  double transition = 0.0;  ///< whitened norm beyond which a misfit fades
  ManufacturingTolerance tolerance;
};

/// Looks for other places of single poles and coils: the torque curve is not monotone, so that an
/// axis may rest where its torques fit badly, or fit as well as elsewhere. Two angles are scanned
/// with all else held, for each axis of `estimated` (ascending) that has torques, over all of them,
/// whether they served or not. All other places of each axis.
std::vector<AxisMode> otherModes(const EstimationProblem& problem,
                                 const WeightedObservations& observations,
                                 const Eigen::VectorXd& x,
                                 const std::vector<Eigen::Index>& estimated,
                                 const ModeSearch& search);

}  // namespace sac
