#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/manufacturing_tolerance.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// What is known of the coordinates of a ParameterSpace before or after a cycle.
struct ParameterBelief {
  Eigen::VectorXd x;           ///< coordinates [rad]
  Eigen::MatrixXd covariance;  ///< of x [rad²], positive semidefinite
};

/// Of which kind a measured 3-vector is: rotor to stator [rad], or on the rotor, rotor frame [N·m].
enum class Quantity { kOrientation, kTorque };

/// One measured 3-vector that takes part in an estimation.
struct Observation {
  std::size_t sample = 0;  ///< index into the samples of the problem
  Quantity quantity = Quantity::kOrientation;
};

/// ε of a set of residuals: mean norm for orientations (paper (16)), root of the mean square norm
/// for torques (paper (29)), root mean square standardised norm for a mixture.
enum class ErrorMeasure { kOrientation, kTorque, kStandardized };
ErrorMeasure errorMeasure(const std::vector<Observation>& observations);

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
  /// Holds for all observations and for those of each stream, coil and pole.
  double max_rejected_fraction = 0.3;
  /// Larger remaining misfit than this: the samples contradict the model.
  double max_reduced_chi_square = 9.0;
  /// Farther from the drawing than so many tolerances nothing was made: it was measured wrongly.
  double max_deviation = 6.0;
  ManufacturingTolerance tolerance;
  /// A coil below this current counts as off [A].
  double current_threshold = kExcitationThreshold;
  /// A joint that moves less than this tells nothing about its axis [rad].
  double min_joint_motion = 0.1;
  /// Assumed where a sample states no uncertainty [rad], [N·m].
  double default_orientation_stddev = 5e-4;
  double default_torque_stddev = 5e-4;
  /// Whether measurements of one dwell share the error of the joints' reading and of the torque
  /// without current. Off, they count as independent.
  bool shared_errors = true;
};

/// Throws ConfigError that names the option and its range.
void validate(const EstimationOptions& options);

}  // namespace sac
