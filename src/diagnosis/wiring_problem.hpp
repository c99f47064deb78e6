#pragma once

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"

namespace sac {

/// The motion of an actuator from what is drawn of it, all coordinates free.
class WiringProblem {
 public:
  /// Keeps a reference to the recording.
  WiringProblem(const Actuator& actuator,
                const MotionRecording& recording,
                const CalibrationConfig& config)
      : model_(ParameterSpace(actuator, withMotionEffects(config.effects))) {
    problem_.model = &model_;
    problem_.recording = &recording;
    problem_.prior = nominalState(model_.space(), config.tolerance).belief;
    for (Eigen::Index p = 0; p < model_.space().size(); ++p) {
      problem_.free.push_back(p);
    }
  }
  WiringProblem(const WiringProblem&) = delete;
  WiringProblem& operator=(const WiringProblem&) = delete;

  const MotionProblem& get() const { return problem_; }

 private:
  CalibrationModel model_;
  MotionProblem problem_;
};

}  // namespace sac
