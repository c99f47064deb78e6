#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"

namespace sac {

/// Whether the parameters in force still describe the machine.
struct ValidityCheck {
  bool is_valid = false;
  /// "Valid to 0.5 mrad (99 %), …", what has changed, or why nothing can be told.
  std::string message;
  /// Mistakes of wiring that came since, where the parameters are not valid any more.
  std::vector<Diagnosis> changes;
};

/// How many of the newest held-out samples judge, and how many of each coil at least, where there
/// are so many.
inline constexpr std::size_t kCheckedSamples = 24;
inline constexpr std::size_t kCheckedSamplesOfACoil = 4;

/// Which held-out samples judge: of a session that goes on for long the newest.
enum class CheckedSamples { kNewest, kAll };

/// Judges held-out samples against the parameters in force: orientations, and torques of each coil,
/// by a chi-square test each. What they would not have noticed is told as the largest rms error of
/// the orientations, and of the torques of the coil that is judged least, that would have passed
/// with a probability of 1 % (non-central chi-square); coils that no sample judges are named, fewer
/// than three poses are told, and those of which an outlier tells last (of a recording: alone) are
/// in doubt, which is not valid. Changes nothing. doc/method.md, Held-out samples.
ValidityCheck checkValidity(const CalibrationSession& session,
                            CheckedSamples checked = CheckedSamples::kNewest);

}  // namespace sac
