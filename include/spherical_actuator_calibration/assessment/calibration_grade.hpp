#pragma once

#include <memory>
#include <string>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// What a calibration is worth, from best to worst. Nothing is good that held-out measurements have
/// not judged.
enum class Grade {
  kGood,          ///< every parameter is identified as well as wanted, held-out samples agree
  kUsable,        ///< held-out samples agree; some parameters or a wanted accuracy are missing
  kNotValidated,  ///< no held-out measurement judges what was identified
  kContradicted,  ///< held-out samples disagree with the parameters
  kFailed,        ///< nothing is identified
};

/// good, usable, not_validated, contradicted, failed: as in messages and reports.
std::string gradeName(Grade grade);
/// Whether something is identified that nothing contradicts: what may be certified and built on.
bool isSound(Grade grade);

/// A grade with its reason.
struct GradedCalibration {
  Grade grade = Grade::kFailed;
  std::string reason;  ///< the whole result in a sentence or two
  /// Whether it is contradicted by what is held out, all of it or the newest; else by a cycle, or
  /// by what its description says.
  bool held_out_contradicts = false;
};

/// Grades the parameters in force of a session, by what is identified and what held-out samples
/// say. A cycle that failed changed nothing, and does not count.
GradedCalibration gradeCalibration(const CalibrationSession& session);

/// The calibrated description of a session, as it is kept: where the newest held-out samples alone
/// contradict it, it says so, too. `graded`: the session's grade.
CalibratedDescription gradedDescription(const CalibrationSession& session,
                                        const CalibrationOrigin& origin,
                                        const GradedCalibration& graded);

/// Grades a session whose samples come one after the other, in the time that a new one takes:
/// what the parameters in force say by themselves is found once.
class CalibrationGrader {
 public:
  /// Keeps a reference; of use until a sample goes or other parameters come into force.
  explicit CalibrationGrader(const CalibrationSession& session);
  ~CalibrationGrader();
  CalibrationGrader(CalibrationGrader&& other) noexcept;
  CalibrationGrader& operator=(CalibrationGrader&& other) noexcept;

  /// By all samples of the session so far.
  GradedCalibration grade();
  /// Does now what the next grade() needs, see HeldOutJudge::settle().
  void settle();

 private:
  class Examiner;

  std::unique_ptr<Examiner> examiner_;
};

}  // namespace sac
