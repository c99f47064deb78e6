#include "noise_factors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"

namespace sac {
namespace {

/// Twice the negative logarithm of the likelihood.
double unlikelihood(const std::vector<NoiseEvidence>& evidence,
                    const NoiseFactors& factors,
                    double share) {
  double sum = 0.0;
  for (const NoiseEvidence& one : evidence) {
    const Eigen::ArrayXd variances =
        factors.joints * one.by_joints + factors.currents * one.by_currents;
    if (!(variances > 0.0).all()) {
      return std::numeric_limits<double>::infinity();
    }
    sum += variances.log().sum() + (one.squares / variances).sum() / share;
  }
  return sum;
}

/// What speaks against a factor beforehand. Differences tell the noise well, but for chance: that
/// it is much smaller has to be certain, and it is not much larger, however badly all fits.
double priorOf(double factor, double chance) {
  constexpr double kCertain = 12.0;
  constexpr double kMost = 9.0;
  const double square = std::pow(std::log(factor) / chance, 2);
  if (factor < 1.0) {
    return std::min(square, kCertain);
  }
  return square <= kMost ? square : std::numeric_limits<double>::infinity();
}

double costOf(const NoiseFactors& factors,
              const std::vector<NoiseEvidence>& evidence,
              const NoiseFactors& chance,
              double share) {
  return unlikelihood(evidence, factors, share) + priorOf(factors.joints, chance.joints) +
         priorOf(factors.currents, chance.currents);
}

}  // namespace

NoiseEvidence noiseEvidence(const WindowBalance& balance,
                            double current_variance,
                            const Eigen::MatrixXd& whitening,
                            const Eigen::VectorXd& residual) {
  const auto half = whitening.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd half_by_joints = half * balance.by_joints;
  const Eigen::MatrixXd half_by_currents = half * balance.by_currents;
  // With their factors they sum up to the identity: both have the same directions.
  const SymmetricEigen joints = symmetricEigen(half * half_by_joints.transpose());
  const Eigen::MatrixXd& directions = joints.vectors;
  const Eigen::MatrixXd by_currents = directions.transpose() * half * half_by_currents.transpose();
  NoiseEvidence evidence;
  evidence.by_joints = joints.values.array().max(0.0);
  evidence.by_currents = current_variance * (by_currents * directions).diagonal().array().max(0.0);
  evidence.squares = (directions.transpose() * residual).array().square();
  return evidence;
}

double likelierBy(const NoiseFactors& others,
                  const NoiseFactors& some,
                  const std::vector<NoiseEvidence>& evidence,
                  const NoiseFactors& chance,
                  double share) {
  return costOf(some, evidence, chance, share) - costOf(others, evidence, chance, share);
}

NoiseFactors likelyFactors(const std::vector<NoiseEvidence>& evidence,
                           const NoiseFactors& chance,
                           double share) {
  constexpr double kLeast = 1e-6;
  constexpr double kFirst = 16.0;
  constexpr double kLast = 1.002;
  NoiseFactors best;
  double least = costOf(best, evidence, chance, share);
  // Over the logarithms of both, with steps that shrink.
  for (double factor = kFirst; factor > kLast; factor = std::sqrt(factor)) {
    for (bool moved = !evidence.empty(); moved;) {
      moved = false;
      for (const NoiseFactors& next : {NoiseFactors{best.joints * factor, best.currents},
                                       NoiseFactors{best.joints / factor, best.currents},
                                       NoiseFactors{best.joints, best.currents * factor},
                                       NoiseFactors{best.joints, best.currents / factor}}) {
        if (next.joints < kLeast || next.currents < kLeast) {
          continue;
        }
        const double value = costOf(next, evidence, chance, share);
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

}  // namespace sac
