#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/calibration/sample_counts.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Cycles as an operator writes them, "joint,poles:1,coil:3,coils,refine", in this order. `coils`
/// becomes a kCoil without a coil: see expandCoils(). Throws ConfigError that names the word which
/// is not understood and the words that are.
std::vector<CycleRequest> parseCycles(const std::string& text);

/// Replaces each kCoil without a coil by one request for every coil that has samples and that no
/// request before identifies.
std::vector<CycleRequest> expandCoils(const std::vector<CycleRequest>& requests,
                                      const CalibrationModel& model,
                                      const std::vector<Sample>& samples,
                                      const EstimationOptions& options);

/// All that the data allow: the joint when orientations were measured, poles with the coil that was
/// excited alone most often, the other coils that were excited alone, and the refinement when there
/// are torques or modelled laboratory effects.
std::vector<CycleRequest> possibleCycles(const CalibrationModel& model,
                                         const std::vector<Sample>& samples,
                                         const EstimationOptions& options);

/// Those of the possible cycles that have as many samples as they need (CycleDemand; at
/// different poses), in their order. Each presumes that those before it have run: other coils
/// need the poles.
std::vector<CycleRequest> nextCycles(const CalibrationModel& model, const SampleCounts& counts);

/// "joint", "poles:1", "coil:3", "refine": inverse of parseCycles() for one request.
std::string cycleText(const CycleRequest& request);

}  // namespace sac
