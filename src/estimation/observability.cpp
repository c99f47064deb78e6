#include "observability.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace sac {

Observability judgeInformation(const Eigen::MatrixXd& information, double limit) {
  constexpr double kParticipation = 0.01;
  Observability result;
  const Eigen::Index n = information.rows();
  if (n == 0) {
    return result;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  // Eigenvalues ascend: the open directions come first.
  Eigen::Index open = 0;
  while (open < n && eigen.eigenvalues()[open] * limit * limit < 1.0) {
    ++open;
  }
  result.rank = n - open;
  result.open_directions = eigen.eigenvectors().leftCols(open);
  const Eigen::VectorXd participation = result.open_directions.rowwise().squaredNorm();
  for (Eigen::Index k = 0; k < n; ++k) {
    if (participation[k] > kParticipation) {
      result.weak.push_back(k);
    }
  }
  if (open < n) {
    result.identified_condition_number =
        std::sqrt(eigen.eigenvalues()[n - 1] / eigen.eigenvalues()[open]);
  }
  const double smallest = eigen.eigenvalues()[0];
  result.condition_number = smallest > 0.0 ? std::sqrt(eigen.eigenvalues()[n - 1] / smallest)
                                           : std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace sac
