#pragma once

#include <optional>
#include <string>

#include "spherical_actuator_calibration/calibration/motion_evidence.hpp"
#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// One thing that an estimate did not model and that its residuals show: a laboratory effect, a
/// scale of a joint's sensor, or a step of a registration or of a joint in the middle of the
/// session.
struct SingleEffect {
  std::string name;          ///< torque_registration, coil_7/gain, joint_2/offset after sample 83
  std::string sentence;      ///< what it is, with value ± standard deviation, and what to do
  double probability = 1.0;  ///< that chance alone shows anything as strong, whatever it is
};

/// What score tests tell of an estimate: no fit is repeated.
struct EffectEvidence {
  /// The most significant one. Nothing where all that is found may be chance, of which a sound
  /// session shows more in less than one of 3000 times.
  std::optional<SingleEffect> found;
  /// In a sentence: a usual mistake that too few samples would not have shown, though it shifts
  /// parameters far beyond their intervals. Empty: none.
  std::string untold;
};

/// `motion`: whose evidence the estimate has joined to that of the samples; null: none.
/// Precondition: the estimate converged, and nothing contradicts it.
EffectEvidence effectEvidence(const EstimationProblem& problem,
                              const Estimate& estimate,
                              const EstimationOptions& options,
                              const MotionEvidence* motion);

}  // namespace sac
