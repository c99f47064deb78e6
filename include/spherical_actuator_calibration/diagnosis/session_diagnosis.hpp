#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"

namespace sac {

/// Mistakes of wiring in the samples of a session, against its description at the start.
std::vector<Diagnosis> diagnoseMistakes(const CalibrationSession& session);

/// The same; where there is none and the samples misfit beyond chance all the same, the single
/// effects of the laboratory and small turns of frames that explain it, each by a refinement from
/// the start. Changes nothing.
std::vector<Diagnosis> diagnose(const CalibrationSession& session);

/// A description that fits what was recorded.
struct Redescription {
  Actuator actuator;
  /// Causes of mistakes that no description can hold.
  std::vector<std::string> beyond_description;
};

/// By the mistakes of wiring that the motion of a session was diagnosed with; nothing: it has none.
std::optional<Redescription> redescribedMotion(const CalibrationSession& session,
                                               const std::vector<Diagnosis>& diagnoses);

/// Sentences of all diagnoses, one after the other; empty without any.
std::string inWords(const std::vector<Diagnosis>& diagnoses);

/// What a session tells of mistakes: the same, or without any that nothing speaks for one, or that
/// its samples are too few to tell.
std::string verdictInWords(const CalibrationSession& session,
                           const std::vector<Diagnosis>& diagnoses);

}  // namespace sac
