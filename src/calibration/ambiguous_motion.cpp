#include "ambiguous_motion.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {

std::string ambiguityInWords(const MotionProblem& problem, const Estimate& estimate) {
  constexpr double kMostStddev = 2.5e-3;  // [rad]
  const ParameterSpace& space = problem.model->space();
  const Eigen::Index first = space.joint(space.joints());
  double worst = 0.0;
  for (const Eigen::Index p : problem.free) {
    const bool is_open = std::find(estimate.unobservable.begin(), estimate.unobservable.end(), p) !=
                         estimate.unobservable.end();
    if (p >= first && p < space.effect() && !is_open) {
      worst = std::max(worst, estimate.belief.covariance(p, p));
    }
  }
  if (worst <= kMostStddev * kMostStddev) {
    return {};
  }
  return format(
      "a pole or coil is told to %.2g mrad only, so that other axes may explain it as well: "
      "excite the coils while the rotor moves (plan_motion), with more current, or record longer.",
      1e3 * std::sqrt(worst));
}

}  // namespace sac
