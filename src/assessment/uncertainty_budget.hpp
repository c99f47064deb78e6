#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// What one source of uncertainty adds to the variances of all parameters.
struct BudgetEntry {
  /// orientation, torque: noise of these measurements; joint_reading, torque_without_current: what
  /// a dwell shares; tracker_registration and so on: what was stated beforehand of an effect;
  /// earlier_knowledge: parameters and directions that the cycle held.
  std::string source;
  Eigen::VectorXd variance;  ///< per parameter of CalibrationSession::parameters(), unit squared
};

/// Uncertainty budget (JCGM 100, 8) of what the last cycle, where it succeeded, has estimated; the
/// variances of all other parameters are zero in it. The variances of one parameter sum up to its
/// stated one, where residuals did not widen that. Empty where there is no such cycle.
std::vector<BudgetEntry> uncertaintyBudget(const CalibrationSession& session);

/// Parameters × sources: shares of the variance, each row with the sum 1, or zero.
Eigen::MatrixXd budgetShares(const std::vector<BudgetEntry>& budget);

}  // namespace sac
