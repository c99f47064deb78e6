#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/core/estimation_problem.hpp"

namespace spherical_actuator_calibration {

/// One observation linearised in all coordinates: residual(x + δ) ≈ residual + jacobian δ.
struct LinearizedObservation {
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> jacobian;  ///< 3×P, zero where unused
  std::vector<Eigen::Index> columns;  ///< coordinates that can be nonzero, ascending
};

/// Noise of an observation and what the uncertainty of coordinates that are not free adds to it.
struct ObservationCovariance {
  Eigen::Matrix3d noise;  ///< sensor noise of the sample, joint sensors included
  Eigen::Matrix3d total;  ///< noise plus the share of held coordinates
};

/// Evaluates the observations of one problem: residuals, Jacobians and covariances.
class ObservationEvaluator {
 public:
  /// Keeps references: the problem must outlive the evaluator.
  ObservationEvaluator(const EstimationProblem& problem, const EstimationOptions& options);

  const std::vector<Excitation>& excitations(std::size_t observation) const {
    return excitations_[observation];
  }

  Eigen::Vector3d residual(std::size_t observation, const Eigen::VectorXd& x) const;

  /// Fills `out`, whose storage is reused.
  void linearize(std::size_t observation,
                 const Eigen::VectorXd& x,
                 LinearizedObservation& out) const;

  /// Covariance of an observation; `held` are the coordinates whose prior uncertainty counts.
  ObservationCovariance covariance(std::size_t observation,
                                   const LinearizedObservation& linear,
                                   const std::vector<bool>& held) const;

 private:
  const EstimationProblem& problem_;
  const EstimationOptions& options_;
  std::vector<std::vector<Excitation>> excitations_;
  bool prior_is_exact_;
};

}  // namespace spherical_actuator_calibration
