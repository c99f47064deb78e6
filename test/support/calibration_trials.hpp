#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/study/cramer_rao_bound.hpp"

namespace sac {

/// Errors of many seeded trials against the bound and against their own intervals.
class TrialStatistics {
 public:
  /// Takes one trial: estimates of the coordinates `free`, their covariance, the truth and the
  /// bound.
  void add(const ParameterBelief& estimated,
           const Eigen::VectorXd& truth,
           const std::vector<Eigen::Index>& free,
           const Eigen::MatrixXd& bound);

  /// Root of the mean over trials of the mean square error, over the same of the bound.
  double errorOverBound() const;
  /// Mean over trials of the root mean square error, over the mean root mean square of the bound.
  double meanErrorOverBound() const;
  /// Share of parameters within 1.96 of their own standard deviations of the truth.
  double coverage() const;

 private:
  double squared_error_ = 0.0;
  double squared_bound_ = 0.0;
  double rms_error_ = 0.0;
  double rms_bound_ = 0.0;
  int covered_ = 0;
  int parameters_ = 0;
};

}  // namespace sac
