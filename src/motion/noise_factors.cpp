#include "noise_factors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {
namespace {

/// A window's residual in the units it was measured in, and both parts of its covariance.
struct Evidence {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_joints;
  Eigen::MatrixXd by_currents;
};

/// Twice the negative logarithm of the likelihood.
double unlikelihood(const std::vector<Evidence>& evidence,
                    const NoiseFactors& factors,
                    double share) {
  double sum = 0.0;
  for (const Evidence& one : evidence) {
    const Cholesky factor(factors.joints * one.by_joints + factors.currents * one.by_currents);
    if (!factor.isPositive()) {
      return std::numeric_limits<double>::infinity();
    }
    const double logarithm = 2.0 * factor.lower().diagonal().array().log().sum();
    sum += logarithm + factor.half(one.residual).squaredNorm() / share;
  }
  return sum;
}

/// The most likely factors, of those that may move.
NoiseFactors walk(const std::vector<Evidence>& evidence,
                  double share,
                  bool joints_move,
                  bool currents_move) {
  constexpr double kLeast = 1e-6;
  NoiseFactors best;
  double least = unlikelihood(evidence, best, share);
  // Over the logarithms of both, with steps that shrink.
  for (double factor = 16.0; factor > 1.02; factor = std::sqrt(factor)) {
    for (bool moved = true; moved;) {
      moved = false;
      const double joint_step = joints_move ? factor : 1.0;
      const double current_step = currents_move ? factor : 1.0;
      for (const NoiseFactors& next : {NoiseFactors{best.joints * joint_step, best.currents},
                                       NoiseFactors{best.joints / joint_step, best.currents},
                                       NoiseFactors{best.joints, best.currents * current_step},
                                       NoiseFactors{best.joints, best.currents / current_step}}) {
        if (next.joints > 1.0 || next.currents > 1.0 || next.joints < kLeast ||
            next.currents < kLeast) {
          continue;
        }
        const double value = unlikelihood(evidence, next, share);
        if (value < least) {
          least = value;
          best = next;
          moved = true;
          break;
        }
      }
    }
  }
  return best;
}

}  // namespace

NoiseFactors likelyFactors(const std::vector<WindowTerm>& windows,
                           double current_variance,
                           double share) {
  // Differences tell the noise well: they are doubted only where likelihood is certain.
  constexpr double kCertain = 12.0;
  std::vector<Evidence> evidence;
  const std::size_t stride = noiseStride(windows.size());
  for (std::size_t n = 0; n < windows.size(); n += stride) {
    const WindowTerm& term = windows[n];
    if (term.serves() && term.isKept()) {
      evidence.push_back({term.whitening.triangularView<Eigen::Lower>().solve(term.residual),
                          term.balance.by_joints,
                          current_variance * term.balance.by_currents});
    }
  }
  NoiseFactors best;
  if (evidence.empty()) {
    return best;
  }
  double least = unlikelihood(evidence, best, share);
  for (const auto& [joints_move, currents_move] :
       {std::pair(false, true), std::pair(true, false), std::pair(true, true)}) {
    const NoiseFactors next = walk(evidence, share, joints_move, currents_move);
    const double value = unlikelihood(evidence, next, share);
    if (value < least - kCertain) {
      least = value;
      best = next;
    }
  }
  return best;
}

}  // namespace sac
