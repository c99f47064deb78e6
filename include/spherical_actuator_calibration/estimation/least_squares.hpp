#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/termination.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// How much a misfit counts.
enum class Loss {
  kSquared,
  kHuber,   ///< linear beyond the transition: converges from afar
  kCauchy,  ///< fades beyond the transition: gross errors lose their pull
};

/// What is known beforehand of some directions of the coordinates.
struct LinearPrior {
  Eigen::MatrixXd directions;  ///< P×d, orthonormal columns
  Eigen::VectorXd mean;        ///< of directionsᵀ x [rad]
  Eigen::MatrixXd covariance;  ///< of directionsᵀ x [rad²], d×d
};

/// One nonlinear least-squares solution over chosen observations and coordinates.
struct LeastSquaresInput {
  const ObservationEvaluator* evaluator = nullptr;
  const std::vector<Whitening>* whitening = nullptr;  ///< W per observation
  const SharedErrorModel* shared = nullptr;           ///< nothing: no errors are shared
  std::vector<bool> active;                           ///< per observation
  std::vector<Eigen::Index> free;                     ///< coordinates to find, ascending
  Eigen::VectorXd start;                              ///< all coordinates
  /// Of the active observations at the start, in all coordinates, where it is known already and the
  /// loss is squared; nothing: it is summed up.
  const InformationSum* at_start = nullptr;
  LinearPrior prior;  ///< counts beside the observations
  Loss loss = Loss::kSquared;
  double loss_transition = 1.0;  ///< whitened norm at which a robust loss takes over
  int max_iterations = 50;
  double parameter_tolerance = 1e-12;  ///< of what is left to go, relative to the coordinates
};

/// Where a minimisation went, and why it ended.
struct LeastSquaresResult {
  Termination termination = Termination::kNumericalFailure;
  std::vector<Eigen::VectorXd> path;  ///< coordinates at the start and after each iteration
  double solve_time = 0.0;            ///< [s]

  const Eigen::VectorXd& solution() const { return path.back(); }
};

/// Minimises Σ ρ(‖W r(x) − G u‖²) + ‖u‖² + ‖prior‖² over x and the errors u that dwells share (they
/// are eliminated dwell by dwell) by Levenberg–Marquardt on normal equations, which are summed
/// up observation by observation: memory does not grow with their number. Normal equations square
/// the condition number, but in each step only: steps go on with fresh residuals until the next one
/// would change nothing, so that the solution keeps the digits of an orthogonal factorisation.
/// Analytic Jacobians, one thread, so that the same input gives the same bits.
LeastSquaresResult solveLeastSquares(const LeastSquaresInput& input);

/// Where one Gauss–Newton step by what is known at the start leads, with the squared loss, whatever
/// it brings; nothing where no step is defined. Precondition: `at_start`.
std::optional<Eigen::VectorXd> afterOneStep(const LeastSquaresInput& input);

}  // namespace sac
