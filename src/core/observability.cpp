#include "spherical_actuator_calibration/core/observability.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace spherical_actuator_calibration {

Observability judgeInformation(const Eigen::MatrixXd& information, double limit) {
  constexpr double kParticipation = 0.01;
  Observability result;
  const Eigen::Index n = information.rows();
  if (n == 0) {
    return result;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  Eigen::VectorXd participation = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (eigen.eigenvalues()[k] * limit * limit >= 1.0) {
      ++result.rank;
    } else {
      participation += eigen.eigenvectors().col(k).cwiseAbs2();
    }
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    if (participation[k] > kParticipation) {
      result.weak.push_back(k);
    }
  }
  const double smallest = eigen.eigenvalues()[0];
  result.condition_number = smallest > 0.0 ? std::sqrt(eigen.eigenvalues()[n - 1] / smallest)
                                           : std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace spherical_actuator_calibration
