#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// How samples that no estimate has used agree with the parameters.
struct HeldOutValidation {
  std::size_t samples = 0;  ///< held out; the rest is meaningless when there are none
  std::size_t orientations = 0;
  double orientation_rms = 0.0;  ///< root mean square norm of the rotation error [rad]
  std::size_t torques = 0;
  double torque_rms = 0.0;  ///< root mean square norm of the torque error [N·m]
  /// Torques of coils that are not identified, or to more than 10 mrad only: too far from linear
  /// in such uncertainties to be judged.
  std::size_t unjudged_torques = 0;
  /// That repeat another measurement bit for bit, in use or held out: they tell nothing, and have
  /// no residual.
  std::size_t repeated = 0;
  /// That stand out by themselves, where they are no more than among the samples in use: they have
  /// a residual that is `rejected`, and no part in the test.
  std::size_t outliers = 0;
  /// Squared Mahalanobis norm of all misfits over their number, with the noise of the samples and
  /// the common uncertainty of the parameters: 1 on average when both are as stated.
  double reduced_chi_square = 0.0;
  /// Probability of misfits at least this large when the stated uncertainties hold.
  double probability = 1.0;
  /// One per observation; `standardized` with its own covariance.
  std::vector<SampleResidual> residuals;

  /// Whether any observation took part in the test.
  bool hasVerdict() const { return residuals.size() > unjudged_torques; }
};

/// Rate at which a cycle rejected outliers; 0: none, so that none is excused elsewhere.
double outlierRate(const CycleReport& report);

/// What windows of motion that were held out tell, in the same words: a window is a sample with a
/// torque, its mean error.
HeldOutValidation validationOf(const HeldOutMotion& motion);

/// Of two that may both have a verdict the one with the less probable misfit.
const HeldOutValidation& severer(const HeldOutValidation& one, const HeldOutValidation& other);

/// Smaller probabilities mean that the held-out samples contradict the parameters.
inline constexpr double kLeastProbability = 1e-3;

/// The verdict in a sentence that an operator can act on.
std::string verdict(const HeldOutValidation& validation);

}  // namespace sac
