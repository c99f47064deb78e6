#include "observability.hpp"

#include <cmath>
#include <limits>

#include "extreme_eigenvalue.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"
#include "spherical_actuator_calibration/estimation/participation.hpp"

namespace sac {

bool leavesNothingOpen(const Eigen::MatrixXd& information, double limit) {
  // All eigenvalues exceed 1/limit² where what they exceed it by has a Cholesky factor.
  return InformationFactor(information,
                           Eigen::VectorXd::Constant(information.rows(), -1.0 / (limit * limit)))
      .isPositive();
}

Observability judgeInformation(const Eigen::MatrixXd& information, double limit) {
  Observability result;
  const Eigen::Index n = information.rows();
  if (n == 0) {
    return result;
  }
  const Eigen::VectorXd values = symmetricEigenvalues(information);
  // Eigenvalues ascend: the open directions come first.
  Eigen::Index open = 0;
  while (open < n && values[open] * limit * limit < 1.0) {
    ++open;
  }
  result.rank = n - open;
  result.open_directions.resize(n, 0);
  if (open > 0) {
    // The vectors cost several times the values, and most sessions leave nothing open.
    result.open_directions = symmetricEigen(information).vectors.leftCols(open);
  }
  result.weak = coordinatesOf(result.open_directions);
  if (open < n) {
    result.identified_condition_number = std::sqrt(values[n - 1] / values[open]);
  }
  const double smallest = values[0];
  result.condition_number = smallest > 0.0 ? std::sqrt(values[n - 1] / smallest)
                                           : std::numeric_limits<double>::infinity();
  return result;
}

double identifiedConditionNumber(const Eigen::MatrixXd& information, double limit) {
  const InformationFactor factor(information);
  if (!factor.isPositive() || !factor.hasIslands() || !leavesNothingOpen(information, limit)) {
    return judgeInformation(information, limit).identified_condition_number;
  }
  // The extreme eigenvalues alone: all of them cost the cube of the number of coordinates.
  const double largest =
      largestEigenvalue([&](const Eigen::VectorXd& v) { return Eigen::VectorXd(information * v); },
                        information.rows());
  const double of_inverse = largestEigenvalue(
      [&](const Eigen::VectorXd& v) { return factor.solve(v); }, information.rows());
  return std::sqrt(largest * of_inverse);
}

}  // namespace sac
