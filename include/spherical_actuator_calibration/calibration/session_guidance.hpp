#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// How far a calibration session has come (message CalibrationStatus).
struct SessionProgress {
  std::uint32_t orientation_samples = 0;      ///< that carry an orientation
  std::vector<std::uint32_t> torque_samples;  ///< that carry a torque, per coil that they excite
  std::uint32_t validation_samples = 0;       ///< held out
  bool joint_done = false;                    ///< the joint is identified
  bool poles_done = false;                    ///< poles are identified
  std::vector<bool> coil_done;                ///< per coil
  bool refined = false;                       ///< by the refinement, since the last other cycle
  bool saved = false;                         ///< the parameters in force are in a file
};

/// What samples and parameters tell of the progress; `refined` and `saved` are not in them.
SessionProgress progressOf(const CalibrationModel& model,
                           const std::vector<Sample>& samples,
                           const CalibrationState& state,
                           const EstimationOptions& options);

/// What the operator should do next, in a sentence that names the service to call or the samples
/// that are missing.
std::string nextStep(const CalibrationModel& model,
                     const std::vector<Sample>& samples,
                     const SessionProgress& progress,
                     const EstimationOptions& options);

}  // namespace sac
