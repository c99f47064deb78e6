#include "delay_search.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

DelayedStep searchDelay(const MotionProblem& problem,
                        const DelayRange& range,
                        const Eigen::VectorXd& loose,
                        MotionTerms& terms) {
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
  for (const double delay : place < 0 ? std::vector<double>{0.0} : range.delays()) {
    Eigen::VectorXd x = problem.prior.x;
    if (place >= 0) {
      x[place] = delay / space.effects().scale(place - space.effect());
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
