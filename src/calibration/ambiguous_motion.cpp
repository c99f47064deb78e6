#include "ambiguous_motion.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "linear_coils.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {

std::string ambiguityInWords(const MotionProblem& problem, const Estimate& estimate) {
  constexpr double kMostStddev = 2.5e-3;  // [rad]
  const ParameterSpace& space = problem.model->space();
  const Eigen::VectorXd variances = variancesBesideCommon(space, estimate.belief.covariance);
  const std::vector<Eigen::Index>& open = estimate.unobservable;
  Eigen::Index worst = 0;
  for (const Eigen::Index p : problem.free) {
    const bool is_magnetic = p >= space.joint(space.joints()) && p < space.effect();
    if (is_magnetic && std::find(open.begin(), open.end(), p) == open.end() &&
        (worst == 0 || variances[p] > variances[worst])) {
      worst = p;
    }
  }
  if (worst == 0 || variances[worst] <= kMostStddev * kMostStddev) {
    return {};
  }
  return format(
      "%s is told to %.2g mrad only, so that other axes may explain the motion as well: excite the "
      "coils while the rotor moves (plan_motion), with more current, or record longer.",
      space.name(worst).c_str(),
      1e3 * std::sqrt(variances[worst]));
}

}  // namespace sac
