#include "observability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "extreme_eigenvalue.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"
#include "spherical_actuator_calibration/estimation/participation.hpp"

namespace sac {
namespace {

/// Columns of `eigen`, of its first `candidates`, that leave a coordinate known no better than
/// `limit`: alone, or else all of the others together with what is known.
std::vector<Eigen::Index> openColumns(const SymmetricEigen& eigen,
                                      Eigen::Index candidates,
                                      double limit) {
  std::vector<Eigen::Index> open;
  std::vector<Eigen::Index> others;
  for (Eigen::Index k = 0; k < candidates; ++k) {
    const double largest = eigen.vectors.col(k).cwiseAbs2().maxCoeff();
    (largest >= limit * limit * eigen.values[k] ? open : others).push_back(k);
  }
  if (others.empty()) {
    return open;
  }
  Eigen::VectorXd variances = Eigen::VectorXd::Zero(eigen.vectors.rows());
  for (const Eigen::Index k : others) {
    variances += eigen.vectors.col(k).cwiseAbs2() / eigen.values[k];
  }
  const Eigen::Index known = eigen.values.size() - candidates;
  variances += eigen.vectors.rightCols(known).cwiseAbs2() * eigen.values.tail(known).cwiseInverse();
  if (variances.maxCoeff() >= limit * limit) {
    open.insert(open.end(), others.begin(), others.end());
    std::sort(open.begin(), open.end());
  }
  return open;
}

}  // namespace

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
  Eigen::Index candidates = 0;
  while (candidates < n && values[candidates] * limit * limit < 1.0) {
    ++candidates;
  }
  std::vector<Eigen::Index> open;
  result.open_directions.resize(n, 0);
  if (candidates > 0) {
    // The vectors cost several times the values, and most sessions leave nothing open.
    const SymmetricEigen eigen = symmetricEigen(information);
    open = openColumns(eigen, candidates, limit);
    result.open_directions.resize(n, static_cast<Eigen::Index>(open.size()));
    for (std::size_t column = 0; column < open.size(); ++column) {
      result.open_directions.col(static_cast<Eigen::Index>(column)) =
          eigen.vectors.col(open[column]);
    }
  }
  result.rank = n - result.open_directions.cols();
  result.weak = coordinatesOf(result.open_directions);
  Eigen::Index first_known = 0;
  for (const Eigen::Index k : open) {
    first_known += k == first_known ? 1 : 0;
  }
  if (first_known < n) {
    result.identified_condition_number = std::sqrt(values[n - 1] / values[first_known]);
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
