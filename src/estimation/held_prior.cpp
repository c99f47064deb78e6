#include "held_prior.hpp"

#include <algorithm>
#include <iterator>

namespace sac {

double statedVariance(const ParameterSpace& space, Eigen::Index coordinate) {
  return coordinate < space.effect() ? 0.0
                                     : space.effects().statedVariance(coordinate - space.effect());
}

std::vector<Eigen::Index> statedOf(const ParameterSpace& space,
                                   const std::vector<Eigen::Index>& coordinates) {
  std::vector<Eigen::Index> result;
  std::copy_if(
      coordinates.begin(), coordinates.end(), std::back_inserter(result), [&](Eigen::Index p) {
        return statedVariance(space, p) > 0.0;
      });
  return result;
}

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
    const Eigen::Index p = stated[static_cast<std::size_t>(k - open)];
    prior.directions(p, k) = 1.0;
    prior.covariance(k, k) = statedVariance(problem.model->space(), p);
  }
  return prior;
}

}  // namespace sac
