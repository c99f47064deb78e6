#include "held_prior.hpp"

#include <cstddef>

namespace sac {

LinearPrior heldPrior(const EstimationProblem& problem,
                      const Eigen::MatrixXd& directions,
                      const std::vector<Eigen::Index>& estimated) {
  const std::vector<Eigen::Index> stated = statedOf(problem.model->space(), estimated);
  const Eigen::Index open = directions.cols();
  const Eigen::Index all = open + static_cast<Eigen::Index>(stated.size());
  LinearPrior prior;
  prior.directions.setZero(directions.rows(), all);
  prior.mean.setZero(all);
  prior.covariance.setZero(all, all);
  prior.directions.leftCols(open) = directions;
  prior.mean.head(open) = directions.transpose() * problem.prior.x;
  prior.covariance.topLeftCorner(open, open) =
      directions.transpose() * problem.prior.covariance * directions;
  for (Eigen::Index k = open; k < all; ++k) {
    prior.directions(stated[static_cast<std::size_t>(k - open)], k) = 1.0;
  }
  prior.covariance.bottomRightCorner(all - open, all - open) =
      statedCovariance(problem.model->space(), stated);
  return prior;
}

}  // namespace sac
