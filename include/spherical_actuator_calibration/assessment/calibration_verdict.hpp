#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/assessment/model_choice.hpp"
#include "spherical_actuator_calibration/assessment/sample_influence.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// What a calibration is worth, from best to worst.
enum class CalibrationGrade {
  kComplete,      ///< everything that was asked for is identified, nothing speaks against it
  kIncomplete,    ///< a cycle failed or left parameters open
  kContradicted,  ///< held-out samples disagree with the parameters
  kFailed,        ///< no cycle succeeded
};

/// complete, incomplete, contradicted, failed: as in reports.
std::string gradeName(CalibrationGrade grade);

/// The judgement of a calibration for people.
struct CalibrationVerdict {
  CalibrationGrade grade = CalibrationGrade::kFailed;
  std::string sentence;                 ///< the whole result in a sentence or two
  std::vector<std::string> next_steps;  ///< what would make it better, most urgent first
};

/// Judges a session by its cycles, open parameters and held-out samples. `influences` are those of
/// its last cycle, `fits` the comparison of its laboratory effects; either may be empty.
CalibrationVerdict judgeCalibration(const CalibrationSession& session,
                                    const std::vector<SampleInfluence>& influences,
                                    const std::vector<ModelFit>& fits);

}  // namespace sac
