#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// What is known of the coordinates of a ParameterSpace before or after a cycle.
struct ParameterBelief {
  Eigen::VectorXd x;           ///< coordinates [rad]
  Eigen::MatrixXd covariance;  ///< of x [rad²], positive semidefinite
};

enum class Quantity { kOrientation, kTorque };

/// One measured 3-vector that takes part in an estimation.
struct Observation {
  std::size_t sample = 0;  ///< index into the samples of the problem
  Quantity quantity = Quantity::kOrientation;
};

/// The one estimation problem of this package. Cycles differ only in which coordinates are free and
/// which observations serve. Coordinates that are not free stay at the prior; their uncertainty
/// (prior.covariance) is carried into weights and result, so that a sequence of cycles stays
/// honest.
struct EstimationProblem {
  const CalibrationModel* model = nullptr;
  const std::vector<Sample>* samples = nullptr;
  std::vector<Observation> observations;
  std::vector<Eigen::Index> free;  ///< coordinates to estimate, ascending
  ParameterBelief prior;
};

/// How the problem is solved and judged.
struct EstimationOptions {
  int max_iterations = 50;
  /// A free direction whose standard deviation from the data exceeds this is not observable [rad].
  double unobservable_stddev = 0.05;
  /// Probability that a faultless set of observations loses any one of them as an outlier.
  double false_alarm_probability = 1e-3;
  /// More outliers than this share: the samples contradict each other.
  double max_rejected_fraction = 0.3;
  /// Larger remaining misfit than this: the samples contradict the model.
  double max_reduced_chi_square = 25.0;
  /// A coil below this current counts as off [A].
  double current_threshold = 0.05;
  /// A joint that moves less than this tells nothing about its axis [rad].
  double min_joint_motion = 0.1;
  /// Assumed where a sample states no uncertainty [rad], [N·m].
  double default_orientation_stddev = 5e-4;
  double default_torque_stddev = 5e-4;
};

/// Throws ConfigError that names the option and its range.
void validate(const EstimationOptions& options);

enum class Termination {
  kConverged,
  kIterationLimit,    ///< max_iterations reached before convergence
  kNumericalFailure,  ///< the solver could not evaluate or factorise
  kTooFewObservations,
  kNothingObservable,
};

/// One observation after the solution.
struct ObservationResidual {
  Observation observation;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< [rad] stator frame or [N·m] rotor frame
  /// Mahalanobis norm over √3 with the residual's own covariance: about 1 when it fits.
  double standardized = 0.0;
  bool rejected = false;
};

/// Result of estimate().
struct Estimate {
  Termination termination = Termination::kNumericalFailure;
  ParameterBelief belief;                  ///< all coordinates, full covariance
  std::vector<Eigen::Index> unobservable;  ///< free coordinates held at the prior for want of data
  /// P×d, orthonormal columns: directions across many coordinates, held at the prior likewise.
  /// Their prior uncertainty is in `belief`.
  Eigen::MatrixXd open_directions;
  int iterations = 0;
  std::vector<double> error_history;  ///< ε before the first and after each iteration
  int degrees_of_freedom = 0;
  double reduced_chi_square = 0.0;  ///< 0 without degrees of freedom
  /// Factor ≥ 1 on standard deviations where the residuals exceed their stated noise significantly.
  double covariance_scale = 1.0;
  double condition_number = 0.0;  ///< of the whitened Jacobian of what was identified
  std::vector<ObservationResidual> residuals;
  double solve_time = 0.0;  ///< [s]
};

/// ε of a set of residuals: mean norm for orientations (paper (16)), root of the mean square norm
/// for torques (paper (29)), root mean square standardised norm for a mixture.
enum class ErrorMeasure { kOrientation, kTorque, kStandardized };
ErrorMeasure errorMeasure(const std::vector<Observation>& observations);

/// Solves the problem: weighted least squares by Levenberg–Marquardt (Ceres) on the manifold. Where
/// the first solution shows misfits, a robust pass finds outliers and a final solution runs without
/// them. What the data cannot tell keeps its prior: see unidentified_part.hpp. Never throws for
/// poor data: see termination. Throws DataError on inconsistent input (index out of range, torque
/// without a torque model).
Estimate estimate(const EstimationProblem& problem, const EstimationOptions& options);

}  // namespace sac
