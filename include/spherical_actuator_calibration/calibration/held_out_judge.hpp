#pragma once

#include <memory>
#include <vector>

#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Judges the held-out samples of a session as they come, in the time that the new ones take.
class HeldOutJudge {
 public:
  /// Keeps a reference to the model. Parameters as validateHeldOut().
  HeldOutJudge(const CalibrationModel& model,
               const CalibrationState& state,
               const EstimationOptions& options,
               UsualOutliers outliers);
  ~HeldOutJudge();
  HeldOutJudge(HeldOutJudge&& other) noexcept;
  HeldOutJudge& operator=(HeldOutJudge&& other) noexcept;

  /// Another verdict, as windows of a motion give it: of two the one with the less probable misfit
  /// counts. `alone`: samples have no say.
  void join(HeldOutValidation other, bool alone);

  /// The verdict over all held-out samples, as validateHeldOut() tells it. `samples`: those of the
  /// call before, in their order, and what came after them. Throws DataError on malformed samples.
  const HeldOutValidation& judge(const std::vector<Sample>& samples);
  /// Does now what the next judge() needs, which for hundreds of coils takes longer than a verdict.
  void settle();

 private:
  class Judgement;

  std::unique_ptr<Judgement> judgement_;
};

/// Judges the held-out samples under a state. Orientations always count, torques where some coil
/// is excited and the model has torque; those of coils that are not identified have a residual but
/// no part in the test. Misfits share the uncertainty of the parameters; the test accounts for it.
/// `outliers`: what cycles rejected among the samples in use. As many, by their rate, come by
/// accident and are set aside; but where the newest torques of a coil are outliers, two or more in
/// a row, it has changed (doc/method.md, Held-out samples). Throws DataError on malformed samples.
HeldOutValidation validateHeldOut(const CalibrationModel& model,
                                  const std::vector<Sample>& samples,
                                  const CalibrationState& state,
                                  const EstimationOptions& options,
                                  const UsualOutliers& outliers = {});

}  // namespace sac
