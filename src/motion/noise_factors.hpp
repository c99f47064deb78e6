#pragma once

#include <vector>

#include <Eigen/Core>

#include "window_balance.hpp"

namespace sac {

/// Factors on the variances of readings and of currents.
struct NoiseFactors {
  double joints = 1.0;
  double currents = 1.0;
};

/// What one window tells of the noise: its residual along directions in which both parts of its
/// covariance are independent. It is small, so that every window of a long recording has its say.
struct NoiseEvidence {
  Eigen::ArrayXd by_joints;    ///< variance along each, where the factor on readings is 1
  Eigen::ArrayXd by_currents;  ///< and where that on currents is 1
  Eigen::ArrayXd squares;      ///< of the residual along each
};

/// Of a window with the covariances of `balance`. `whitening`: by their sum, each with any factor;
/// `residual`: whitened; `current_variance` [A²].
NoiseEvidence noiseEvidence(const WindowBalance& balance,
                            double current_variance,
                            const Eigen::MatrixXd& whitening,
                            const Eigen::VectorXd& residual);

/// The most likely ones: what differences of neighbours take for noise can be motion or control,
/// but noise is no larger than they say, but for what chance has made of them.
/// `share`: of what the residuals have left of the noise after the solution, below 1.
/// `chance`: standard deviations of both variances by differences, over their value.
NoiseFactors likelyFactors(const std::vector<NoiseEvidence>& evidence,
                           const NoiseFactors& chance,
                           double share);

/// By how much others are likelier than some, as a χ².
double likelierBy(const NoiseFactors& others,
                  const NoiseFactors& some,
                  const std::vector<NoiseEvidence>& evidence,
                  const NoiseFactors& chance,
                  double share);

}  // namespace sac
