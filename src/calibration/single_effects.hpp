#pragma once

#include <optional>
#include <string>

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

/// The most significant one, by score tests: no fit is repeated. Nothing where all that is found
/// may be chance, of which a sound session shows more in less than one of 3000 times.
/// Precondition: the estimate converged, and nothing contradicts it.
std::optional<SingleEffect> findSingleEffect(const EstimationProblem& problem,
                                             const Estimate& estimate,
                                             const EstimationOptions& options);

}  // namespace sac
