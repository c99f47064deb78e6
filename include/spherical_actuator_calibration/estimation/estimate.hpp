#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/least_squares.hpp"

namespace sac {

/// One observation after the solution.
struct ObservationResidual {
  Observation observation;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< [rad] stator frame or [N·m] rotor frame
  /// Mahalanobis norm over √3 with the residual's own covariance: about 1 when it fits.
  double standardized = 0.0;
  bool rejected = false;
};

/// What an estimation found.
struct Estimate {
  Termination termination = Termination::kNumericalFailure;
  ParameterBelief belief;                  ///< all coordinates, full covariance
  std::vector<Eigen::Index> unobservable;  ///< free coordinates held at the prior for want of data
  /// P×d, orthonormal columns: directions across many coordinates, held at the prior likewise.
  /// Their prior uncertainty is in `belief`.
  Eigen::MatrixXd open_directions;
  /// Free coordinates of poles and coils whose torques were rejected, so that the rest tells
  /// nothing of them.
  std::vector<Eigen::Index> rejected_away;
  /// First coordinates of poles and coils that another place explains as well; `belief` is widened
  /// by the distance to it.
  std::vector<Eigen::Index> ambiguous;
  int iterations = 0;
  std::vector<double> error_history;  ///< ε before the first and after each iteration
  int degrees_of_freedom = 0;
  /// Normalised misfit of the stated standard deviations of effects, root mean square; 0 without.
  double stated_misfit = 0.0;
  double reduced_chi_square = 0.0;  ///< 0 without degrees of freedom
  /// Factor ≥ 1 on standard deviations where the residuals exceed their stated noise significantly.
  double covariance_scale = 1.0;
  double condition_number = 0.0;  ///< of the whitened Jacobian of what was identified
  std::vector<ObservationResidual> residuals;
  double solve_time = 0.0;  ///< [s]
};

}  // namespace sac
