#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/core/calibration_model.hpp"
#include "spherical_actuator_calibration/core/estimation_problem.hpp"
#include "spherical_actuator_calibration/core/sample.hpp"

namespace spherical_actuator_calibration {

/// How samples that no estimate has used agree with the parameters.
struct HeldOutValidation {
  std::size_t samples = 0;  ///< held out; the rest is meaningless when there are none
  std::size_t orientations = 0;
  double orientation_rms = 0.0;  ///< root mean square norm of the rotation error [rad]
  std::size_t torques = 0;
  double torque_rms = 0.0;  ///< root mean square norm of the torque error [N·m]
  /// Near 1 when the misfits are what the uncertainty of samples and parameters explains.
  double reduced_chi_square = 0.0;
};

/// Judges the held-out samples under `belief`. Orientations always count, torques where some coil
/// is excited and the model has torque. Throws DataError on malformed samples.
HeldOutValidation validateHeldOut(const CalibrationModel& model,
                                  const std::vector<Sample>& samples,
                                  const ParameterBelief& belief,
                                  const EstimationOptions& options);

}  // namespace spherical_actuator_calibration
