#include "spherical_actuator_calibration/motion/rough_motion.hpp"

#include <cmath>

#include "delay_search.hpp"

namespace sac {

double roughMisfit(const MotionProblem& problem, double variance, const DelayRange& range) {
  constexpr double kNoOutliers = 1e12;
  constexpr int kMostScalings = 3;
  MotionOptions options;
  options.hold_out_every = 0;
  options.most_windows = 30;
  MotionTerms terms(problem, options);
  const auto values =
      static_cast<double>(terms.windowCount()) * static_cast<double>(terms.valuesPerWindow());
  if (values < static_cast<double>(problem.free.size())) {
    return -1.0;
  }
  terms.setScales(kNoOutliers, kNoOutliers);
  // What nothing is known of moves freely.
  constexpr double kLeast = 1e-6;
  const Eigen::VectorXd loose =
      problem.prior.covariance.diagonal().cwiseMax(kLeast * kLeast).cwiseSqrt();
  double used = variance > 0.0 ? variance : 1e4;
  double left = 0.0;
  for (int n = 0; n < (variance > 0.0 ? 1 : kMostScalings); ++n) {
    left = searchDelay(problem, range, loose / std::sqrt(used), terms).left / values;
    used = left;
  }
  return left;
}

}  // namespace sac
