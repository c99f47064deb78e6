#include "delay_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

DelayedStep searchDelay(const MotionProblem& problem,
                        const MotionOptions& options,
                        const Eigen::VectorXd& loose,
                        MotionTerms& terms) {
  constexpr double kGrid = 0.01;  // [s]
  constexpr std::size_t kEnoughWindows = 30;
  const Eigen::Index place = terms.places().current_delay;
  const ParameterSpace& space = problem.model->space();
  TermOrder sparse;
  sparse.balance.stride = terms.coarseStride();
  sparse.every = std::max<std::size_t>(1, terms.windowCount() / kEnoughWindows);
  sparse.orientations = false;
  std::vector<Eigen::Index> others = problem.free;
  others.erase(std::remove(others.begin(), others.end(), place), others.end());
  const Eigen::VectorXd held = loose(others).cwiseAbs2().cwiseInverse();
  DelayedStep best{0.0, problem.prior.x};
  double least = std::numeric_limits<double>::infinity();
  const int reach =
      place < 0 ? 0 : static_cast<int>(std::floor(options.largest_delay / kGrid + 1e-9));
  for (int n = -reach; n <= reach; ++n) {
    Eigen::VectorXd x = problem.prior.x;
    if (place >= 0) {
      x[place] = kGrid * n / space.effects().scale(place - space.effect());
    }
    terms.linearize(x, sparse);
    const InformationSum sum = terms.balance(x);
    Eigen::MatrixXd information = sum.information()(others, others);
    information.diagonal() += held;
    const Eigen::VectorXd gradient = sum.gradient()(others);
    const Eigen::VectorXd back = solveSemidefinite(information, gradient);
    const double left = sum.squaredMisfit() - gradient.dot(back);
    if (left < least) {
      least = left;
      best.left = left;
      best.delay = place < 0 ? 0.0 : x[place];
      best.x = x;
      best.x(others) -= back;
    }
  }
  return best;
}

}  // namespace sac
