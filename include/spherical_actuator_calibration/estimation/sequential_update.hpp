#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// Observations taken in one after the other: Kalman's filter in P coordinates and the errors that
/// observations of one dwell share. Exactly the linear least squares over all of them and the
/// prior, in O(P²) for each.
class SequentialUpdate {
 public:
  /// @param covariance of the coordinates before any observation, P×P, positive semidefinite
  explicit SequentialUpdate(const Eigen::MatrixXd& covariance)
      : SequentialUpdate(Eigen::VectorXd::Zero(covariance.rows()), covariance) {}
  /// @param mean of the coordinates before any observation
  SequentialUpdate(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance);

  /// The next observation shares no error with those before.
  void beginDwell();
  /// Takes in residual + J δ − G u = noise, with unit noise.
  /// @param loading G of the errors u of the present dwell
  void observe(const WhitenedObservation& observation, const SharedLoading& loading);

  /// Does now what takes most of the time for many coordinates, and what some later observation
  /// would do else: nothing that is told waits for it.
  void settle();

  /// Of the coordinates, after all observations so far.
  Eigen::VectorXd mean() const { return mean_.head(size()); }
  Eigen::MatrixXd covariance() const;

  /// Squared Mahalanobis norm of all observations under the prior: what none of them foresaw of the
  /// next, in units of its uncertainty. Of residuals r with Jacobian J this is rᵀ (I + J P Jᵀ)⁻¹ r.
  double chiSquare() const { return chi_square_; }

 private:
  Eigen::Index size() const { return mean_.size() - kSharedErrors; }
  auto gains() const { return gains_.leftCols(gain_columns_); }

  // Of the coordinates, then of the errors of the present dwell.
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
  /// The covariance has yet to go by −K Kᵀ with the first gain_columns_ of these: K of the last
  /// observations, side by side.
  Eigen::MatrixXd gains_;
  Eigen::Index gain_columns_ = 0;
  double chi_square_ = 0.0;
};

}  // namespace sac
