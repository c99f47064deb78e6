#include "residual_alignment.hpp"

#include <cmath>

namespace sac {

ResidualAlignment residualAlignment(const MotionTerms& terms,
                                    const std::vector<Eigen::Index>& estimated,
                                    const Eigen::MatrixXd& inverse) {
  const std::size_t stride = keptStride(terms.windowCount());
  double found = 0.0;
  double expected = 0.0;
  double variance = 0.0;
  for (std::size_t n = 0; n < terms.windowCount(); ++n) {
    const WindowTerm& term = terms.windows()[n];
    // Of a sum, others are kept because they stand out.
    if (!term.serves() || !term.isKept() || (terms.areSummed() && n % stride != 0)) {
      continue;
    }
    const Eigen::MatrixXd of_estimated = term.balance.jacobian(Eigen::all, estimated);
    const Eigen::MatrixXd jacobian = term.whitening.triangularView<Eigen::Lower>() * of_estimated;
    const Eigen::MatrixXd shift = inverse * jacobian.transpose();
    const Eigen::MatrixXd share = jacobian * shift;
    found += (jacobian.transpose() * term.residual).dot(shift * term.residual);
    const double squares = share.squaredNorm();
    // What the estimate has taken of the residual itself is missing in it.
    expected += share.trace() - squares;
    variance += 2.0 * squares;
  }
  ResidualAlignment alignment;
  if (expected > 0.0) {
    alignment.ratio = found / expected;
    alignment.chance = std::sqrt(variance) / expected;
  }
  return alignment;
}

}  // namespace sac
