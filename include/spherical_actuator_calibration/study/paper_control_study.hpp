#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/study/closed_loop_simulation.hpp"
#include "spherical_actuator_calibration/study/paper_study.hpp"
#include "spherical_actuator_calibration/study/torque_matrix_error.hpp"

namespace sac {

/// The paper's desired motion, q₁ = πt/48 (section 4.3.3).
DesiredMotion paperTrajectory(double time);

/// Poles and coils as drawn on the joints as made: what level 1 alone can give.
Actuator levelOneActuator(const Actuator& nominal, const Actuator& truth);

/// Closed loop along the paper's trajectory with one model.
struct ControlRun {
  std::string model;  ///< nominal, level_1 or both_levels
  bool loaded = false;
  ClosedLoopResult result;
};
/// The three models without and with a load [N·m, rotor frame], which the control knows.
std::vector<ControlRun> studyControl(const PaperStudyOptions& options, const Eigen::Vector3d& load);

/// How far torques are missed over the workspace, by parameters of one kind.
struct TorqueErrorRun {
  std::string model;  ///< nominal, level_1, sequential or refined
  std::vector<TorqueMatrixError> poses;
};
/// Sequential and refined parameters come from sessions after the paper's protocol with noise, as
/// many as `sessions`; `poses` random poses within `tilt` [rad] each.
std::vector<TorqueErrorRun> studyTorqueErrors(const PaperStudyOptions& options,
                                              std::uint64_t sessions,
                                              std::size_t poses,
                                              double tilt);

}  // namespace sac
