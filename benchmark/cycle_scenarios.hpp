#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac::benchmarks {

/// Everything that one cycle starts from, and the truth it should find.
struct CycleScenario {
  CalibrationModel model;
  CycleRequest request;
  std::vector<Sample> samples;
  CalibrationState state;
  Actuator truth;
};

/// The paper's actuator before a cycle, with `samples` noiseless samples of the paper's ranges
/// (±0.6 rad for orientations, 2 A for torques), the same at every call. What the paper takes as
/// known is known exactly: the joints before kPoles, and the poles, too, before kCoil (coil 2 of
/// the paper). kRefine begins as far from the truth as the sequence of cycles ends; one in 13 of
/// its samples is an orientation, the others are torques of all coils in turn.
CycleScenario cycleScenario(Cycle cycle, std::size_t samples);

/// The refinement of an actuator with as many coils as wanted (a multiple of 8, in as many layers),
/// `samples` in all, each coil's at poses where it sees poles.
CycleScenario manyCoilsScenario(std::size_t coils, std::size_t samples);

/// All observations that its cycle takes. Keeps pointers to model and samples of the scenario.
EstimationProblem problemOf(const CycleScenario& scenario);

/// Largest error that noiseless samples may leave [rad].
inline constexpr double kExact = 1e-10;

/// Largest difference between coordinates `x` and the truth over those that the cycle estimates
/// [rad].
double worstError(const CycleScenario& scenario, const Eigen::VectorXd& x);

/// The scenario and its solution as a JSON object, every number exact, for the reference script.
std::string toJson(const CycleScenario& scenario, const CalibrationState& solution);

}  // namespace sac::benchmarks
