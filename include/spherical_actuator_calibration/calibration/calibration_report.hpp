#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/cycle_request.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/open_directions.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// One parameter after a cycle (message ParameterEstimate), in its unit.
struct ParameterEstimate {
  std::string name;
  double nominal = 0.0;
  double initial = 0.0;  ///< before the cycle
  double value = 0.0;
  double stddev = 0.0;  ///< of value; of the prior where not observable
  /// False: the value is the initial one, or, where the parameter takes part in an open direction,
  /// differs from it by no more than what the data tell.
  bool observable = false;
  std::string unit = "rad";  ///< of all its numbers: rad, N·m, or 1
};

/// One observation after a cycle (message SampleResidual).
struct SampleResidual {
  std::uint32_t id = 0;
  Quantity quantity = Quantity::kOrientation;
  double residual = 0.0;      ///< norm [rad] or [N·m]
  double standardized = 0.0;  ///< about 1 when it fits its stated uncertainty
  bool rejected = false;
  std::string reason;  ///< why rejected, in words; else empty
};

/// What a cycle tells (message CalibrationReport).
struct CycleReport {
  Cycle cycle = Cycle::kJoint;
  std::optional<std::size_t> coil = std::nullopt;  ///< excited coil; none where the cycle has none
  bool success = false;
  /// Refused because the samples contradict each other, the model or the drawing.
  bool contradicted = false;
  std::string message;                 ///< a sentence or two that an operator can act on
  std::uint32_t samples_used = 0;      ///< in the final fit; of the cycle motion windows
  std::uint32_t samples_rejected = 0;  ///< of which something is an outlier; likewise
  std::uint32_t iterations = 0;
  ErrorMeasure error_measure = ErrorMeasure::kOrientation;
  std::vector<double> error_history;  ///< before the first and after each iteration, in its unit
  /// What keeps a successful cycle from being good, a sentence each.
  std::vector<std::string> doubts;
  double reduced_chi_square = 0.0;  ///< of the final fit: 1 where the model and stated noise hold
  int degrees_of_freedom = 0;
  double condition_number = 0.0;  ///< of the whitened Jacobian
  double solve_time = 0.0;        ///< [s]
  std::vector<ParameterEstimate> estimates;
  std::vector<OpenDirection> open_directions;  ///< beside single unobservable parameters
  std::vector<SampleResidual> residuals;
  // See workspace_uncertainty.hpp; 0 where the request left them out.
  double orientation_uncertainty = 0.0;                ///< [rad]
  double torque_uncertainty = 0.0;                     ///< [N·m/A]
  std::optional<MotionSummary> motion = std::nullopt;  ///< of the cycle motion
  /// What was stated of the registrations, by inWords(); empty: not known.
  std::string registration;
};

/// Unit of the error history of a cycle: rad, N·m, or 1 for standardized errors.
std::string unitOf(ErrorMeasure measure);

/// orientation or torque, and the unit of its residuals: rad or N·m.
std::string quantityName(Quantity quantity);
std::string unitOf(Quantity quantity);

/// Root mean square norm of the residuals of one kind that were not rejected; nothing when there
/// are none.
std::optional<double> residualRms(const CycleReport& report, Quantity quantity);

}  // namespace sac
