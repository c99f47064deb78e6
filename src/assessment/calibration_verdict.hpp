#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/assessment/model_choice.hpp"
#include "spherical_actuator_calibration/assessment/sample_influence.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// The judgement of a calibration for people.
struct CalibrationVerdict {
  GradedCalibration graded;
  std::vector<std::string> next_steps;  ///< what would make it better, most urgent first
};

/// Judges a session and says what to do next. `influences` are those of
/// its last cycle, `fits` the comparison of its laboratory effects; either may be empty.
CalibrationVerdict judgeCalibration(const CalibrationSession& session,
                                    const std::vector<SampleInfluence>& influences,
                                    const std::vector<ModelFit>& fits);

}  // namespace sac
