#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/study/free_axis_calibration.hpp"

namespace sac {

/// The simulations of the paper's section 4.3. The paper prints no orientations, hence each is run
/// on many random sets of them.
struct PaperStudyOptions {
  /// On which side of R_stator_rotor the noise of an orientation turns.
  enum class NoiseSide { kStator, kRotor };

  Actuator nominal;
  Actuator truth;
  std::uint64_t seeds = 200;        ///< random sets per simulation, ≥ 1
  double joint_tilt = 0.6;          ///< of the orientations of level 1 [rad]
  double torque_tilt = 0.3;         ///< of those of level 2 [rad]
  double orientation_noise = 1e-3;  ///< uniform within ± this per component [rad]
  NoiseSide noise_side = NoiseSide::kStator;
  double torque_noise = 5e-4;  ///< uniform within ± this per component [N·m]
  double current = 2.0;        ///< of the excited coil [A]
  EstimationOptions estimation;
};

/// Throws ConfigError when an option is not valid or the actuators are not of one design.
void validate(const PaperStudyOptions& options);

/// Level 1 from `orientations` without noise (Table 4, Figures 6 and 7).
struct LevelOneRun {
  std::vector<double> errors;  ///< ε₁ before the first and after each iteration of the joint cycle
  /// Largest deviation of an axis component, and of an offset [rad], from the true ones: before the
  /// first and after each iteration of the paper's twelve unknowns.
  std::vector<double> axis_deviation_newton;
  std::vector<double> axis_deviation_chord;
  std::vector<double> offset_deviation_chord;
  std::vector<double> errors_chord;  ///< ε₁ [rad]
  std::vector<FreeAxes> chord;       ///< parameters before the first and after each iteration
};
std::vector<LevelOneRun> studyLevelOne(const PaperStudyOptions& options,
                                       std::size_t orientations = 5);

/// Level 1 with noise from so many orientations (Figure 8). Mean norms over the set [rad].
struct LevelOneNoiseRun {
  double added_noise = 0.0;
  double error = 0.0;        ///< ε₁ after the joint cycle; infinite when that is not possible
  double paper_error = 0.0;  ///< ε₁ after the paper's twelve unknowns
  double true_error = 0.0;   ///< mean error against the noiseless truth elsewhere in the workspace
};
std::vector<LevelOneNoiseRun> studyLevelOneNoise(const PaperStudyOptions& options,
                                                 std::size_t orientations);

/// Level 2, on exactly known joints: situation 1 (all poles and coil 1) or 2 (coil 2, poles known).
enum class Situation { kPolesAndCoil, kCoil };

/// Where the orientations of level 2 come from.
enum class Orientations {
  kRandom,       ///< as in the paper
  kLargeTorque,  ///< of a hundred times as many random ones those with the largest nominal torques
  kPlanned,      ///< by planPoses() for the nominal actuator; the same for every seed
};

/// One calibration of poles and coils by a set of orientations.
struct LevelTwoRun {
  bool observable = false;     ///< every wanted parameter was identified
  std::vector<double> errors;  ///< ε₂ [N·m] before the first and after each iteration
  double largest_error = 0.0;  ///< of an identified parameter [rad]
  double largest_share = 0.0;  ///< of an identified parameter, over its assigned error
  std::vector<ParameterEstimate>
      estimates;  ///< of all parameters that the cycle was free to change
};
/// `noise`: with that of the options, or none.
std::vector<LevelTwoRun> studyLevelTwo(const PaperStudyOptions& options,
                                       Situation situation,
                                       Orientations orientations,
                                       std::size_t measurements,
                                       bool noise);

}  // namespace sac
