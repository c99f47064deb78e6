#include "calibration_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "spherical_actuator_calibration/assessment/torque_linearity.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/calibration/operator_advice.hpp"
#include "spherical_actuator_calibration/calibration/session_guidance.hpp"
#include "spherical_actuator_calibration/calibration/session_progress.hpp"
#include "spherical_actuator_calibration/estimation/misfit.hpp"

namespace sac {
namespace {

/// "3, 7, 8 and 4 more" of ascending numbers.
std::string enumerate(const std::vector<std::uint32_t>& ids) {
  constexpr std::size_t kMostNamed = 8;
  std::string text;
  for (std::size_t n = 0; n < ids.size() && n < kMostNamed; ++n) {
    text += n == 0 ? "" : ", ";
    text += std::to_string(ids[n]);
  }
  if (ids.size() > kMostNamed) {
    text += " and " + std::to_string(ids.size() - kMostNamed) + " more";
  }
  return text;
}

/// Collects grade, sentence and next steps of one session.
class Judge {
 public:
  Judge(const CalibrationSession& session,
        const std::vector<SampleInfluence>& influences,
        const std::vector<ModelFit>& fits)
      : session_(session),
        influences_(influences),
        fits_(fits),
        graded_(gradeCalibration(session)),
        open_(session.openParameters()) {
    for (const CycleReport& report : session.reports()) {
      last_success_ = report.success ? &report : last_success_;
    }
  }

  CalibrationVerdict verdict() const {
    CalibrationVerdict verdict;
    verdict.graded = graded_;
    collectSteps(verdict.next_steps);
    return verdict;
  }

 private:
  void collectSteps(std::vector<std::string>& steps) const {
    if (graded_.grade == Grade::kContradicted && !session_.samples().empty()) {
      steps.emplace_back(
          "Find out why what was held out differs: compare its residuals with those of what is in "
          "use, and check that nothing was moved in between.");
    }
    addFailures(steps);
    addOpen(steps);
    addGuidance(steps);
    addRejected(steps);
    addMisfit(steps);
    addIrreplaceable(steps);
    addModelChoice(steps);
    addLinearity(steps);
    addValidation(steps);
    if (steps.empty()) {
      addWeakest(steps);
    }
  }

  /// The last word of each cycle that did not succeed.
  void addFailures(std::vector<std::string>& steps) const {
    std::map<std::string, const CycleReport*> last;
    for (const CycleReport& report : session_.reports()) {
      last[cycleText({report.cycle, report.coil})] = &report;
    }
    for (const auto& [name, report] : last) {
      if (!report->success) {
        steps.push_back(report->message);
      }
    }
  }

  void addOpen(std::vector<std::string>& steps) const {
    if (open_.empty() || last_success_ == nullptr) {
      return;
    }
    if (!last_success_->open_directions.empty()) {
      steps.emplace_back(
          "Measure the orientation at 3 or more poses: torques alone leave open how the stator is "
          "turned.");
      return;
    }
    const ParameterSpace& space = session_.model().space();
    std::vector<Eigen::Index> coordinates;
    for (Eigen::Index p = 0; p < space.size(); ++p) {
      if (std::find(open_.begin(), open_.end(), space.name(p)) != open_.end()) {
        coordinates.push_back(p);
      }
    }
    const EstimationOptions& estimation = session_.config().estimation;
    const std::vector<std::string> advice = adviceForUnobservable(
        session_.model(),
        session_.samples(),
        selectObservations(
            session_.model().space(), session_.samples(), {Cycle::kRefine}, estimation),
        {Cycle::kPoles, polesCoil()},
        session_.state().belief.x,
        estimation,
        coordinates);
    steps.insert(steps.end(), advice.begin(), advice.end());
  }

  /// Coil that the poles were measured with.
  std::optional<std::size_t> polesCoil() const {
    for (const CycleReport& report : session_.reports()) {
      if (report.cycle == Cycle::kPoles) {
        return report.coil;
      }
    }
    return 0;
  }

  /// What was not tried yet.
  void addGuidance(std::vector<std::string>& steps) const {
    SessionProgress progress = progressOf(
        session_.model(), session_.samples(), session_.state(), session_.config().estimation);
    progress.refined = last_success_ != nullptr && last_success_->cycle == Cycle::kRefine;
    const bool has_all_coils =
        std::find(progress.coil_done.begin(), progress.coil_done.end(), false) ==
        progress.coil_done.end();
    const bool torque_done = !session_.model().hasTorqueModel() ||
                             (progress.poles_done && has_all_coils && progress.refined);
    if (progress.joint_done && torque_done) {
      return;
    }
    steps.push_back(nextStep(session_.model(), progress));
  }

  void addRejected(std::vector<std::string>& steps) const {
    if (last_success_ == nullptr || last_success_->samples_rejected == 0) {
      return;
    }
    std::vector<std::uint32_t> ids;
    for (const SampleResidual& residual : last_success_->residuals) {
      if (residual.rejected && (ids.empty() || ids.back() != residual.id)) {
        ids.push_back(residual.id);
      }
    }
    const bool are_windows = last_success_->cycle == Cycle::kMotion;
    steps.push_back(std::string("Look at the ") +
                    (are_windows ? "windows that are left out" : "rejected samples") + " (" +
                    enumerate(ids) +
                    "): was the tracker's view blocked, the rotor touched, a current switched?");
  }

  void addMisfit(std::vector<std::string>& steps) const {
    constexpr double kNotable = 1.5;
    if (last_success_ == nullptr || last_success_->reduced_chi_square < kNotable) {
      return;
    }
    const double freedom = last_success_->degrees_of_freedom;
    steps.push_back(
        format("Residuals are %.1f times their stated uncertainty: model a laboratory effect "
               "(effects in the configuration), or correct the stated noise.%s",
               std::sqrt(last_success_->reduced_chi_square),
               isMisfit(freedom * last_success_->reduced_chi_square, freedom)
                   ? " All standard deviations here are already widened by it."
                   : " It may be chance: standard deviations are not widened by it."));
  }

  void addIrreplaceable(std::vector<std::string>& steps) const {
    std::vector<std::uint32_t> ids;
    for (const SampleInfluence& influence : influences_) {
      if (influence.irreplaceable && (ids.empty() || ids.back() != influence.id)) {
        ids.push_back(influence.id);
      }
    }
    if (!ids.empty()) {
      const bool is_one = ids.size() == 1;
      const char* them = is_one ? "it" : "them";
      steps.push_back(
          format("%s %s checked by no other: an error in %s would show in held-out samples alone. "
                 "Further poses near %s would check %s.",
                 is_one ? "Sample" : "Samples",
                 (enumerate(ids) + (is_one ? " is" : " are")).c_str(),
                 them,
                 is_one ? "its own" : "theirs",
                 them));
    }
  }

  void addModelChoice(std::vector<std::string>& steps) const {
    if (fits_.empty()) {
      return;
    }
    const ModelFit& best = bestOf(fits_);
    if (best.converged && best.effects != "all") {
      steps.push_back("The samples are explained best by other laboratory effects: \"" +
                      best.effects + "\" instead of all that are modelled.");
    }
  }

  void addLinearity(std::vector<std::string>& steps) const {
    const auto linearity = torqueLinearity(session_.samples(), session_.config());
    if (linearity && !linearity->isProportional()) {
      steps.push_back(describe(linearity) +
                      " Calibrate at the currents that the actuator is to work with.");
    }
  }

  void addValidation(std::vector<std::string>& steps) const {
    if (graded_.grade == Grade::kNotValidated) {
      steps.emplace_back(
          "Hold out samples, so that the calibration is judged by what it has not seen: capture a "
          "few poses for validation, or set validation.hold_out_every.");
    }
  }

  /// Angles only: what has another unit does not compare with them.
  void addWeakest(std::vector<std::string>& steps) const {
    const std::vector<ParameterEstimate> all = session_.parameters();
    const ParameterEstimate* weakest = nullptr;
    for (const ParameterEstimate& one : all) {
      if (one.unit == "rad" && (weakest == nullptr || one.stddev > weakest->stddev)) {
        weakest = &one;
      }
    }
    steps.push_back(
        format("Nothing needs to be done. The least certain parameter is %s "
               "(± %.2g mrad); further poses, planned by plan_session or plan_poses, "
               "make it better.",
               weakest->name.c_str(),
               1e3 * weakest->stddev));
  }

  const CalibrationSession& session_;
  const std::vector<SampleInfluence>& influences_;
  const std::vector<ModelFit>& fits_;
  const GradedCalibration graded_;
  const std::vector<std::string> open_;
  const CycleReport* last_success_ = nullptr;
};

}  // namespace

CalibrationVerdict judgeCalibration(const CalibrationSession& session,
                                    const std::vector<SampleInfluence>& influences,
                                    const std::vector<ModelFit>& fits) {
  return Judge(session, influences, fits).verdict();
}

}  // namespace sac
