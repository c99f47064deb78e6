#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// How well the samples in use look at the joint, a pole or a coil (message Coverage).
struct Coverage {
  std::uint32_t samples = 0;  ///< that tell something about it; held-out ones never count
  std::uint32_t wanted = 1;   ///< samples from which on it is seen well enough
  bool identified = false;    ///< all its parameters are

  bool isSeenWell() const { return samples >= wanted; }
};

/// How far a calibration session has come (message CalibrationStatus).
struct SessionProgress {
  Coverage joint;               ///< samples with an orientation: see usefulOrientations()
  std::vector<Coverage> poles;  ///< torque samples in which an excited coil reaches the pole
  std::vector<Coverage> coils;  ///< torque samples in which the excited coil reaches some pole
  std::vector<CycleRequest> next_cycles;      ///< see nextCycles()
  std::uint32_t orientation_samples = 0;      ///< that carry an orientation
  std::vector<std::uint32_t> torque_samples;  ///< that carry a torque, per coil that they excite
  std::uint32_t validation_samples = 0;       ///< held out
  bool joint_done = false;                    ///< the joint is identified
  bool poles_done = false;                    ///< poles are identified
  std::vector<bool> coil_done;                ///< per coil
  bool refined = false;                       ///< by the refinement, since the last other cycle
  bool saved = false;                         ///< the parameters in force are in a file
  bool contradicted = false;                  ///< held-out samples disagree with what is in force
  std::string plan_step;  ///< next pose of the plan that is followed, see planStep(); empty: none
};

/// What samples and parameters tell of the progress; `refined`, `saved`, `contradicted` and
/// `plan_step` are not in them.
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
