#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/mending_cycle.hpp"
#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "unstated_registration.hpp"

namespace sac {
/// Collects what speaks for and against one session.
class CalibrationGrader::Examiner {
 public:
  explicit Examiner(const CalibrationSession& session) : session_(session) {
    for (const CycleReport& report : session.reports()) {
      last_success_ = report.success ? &report : last_success_;
      // Mended: a refinement, for instance, takes all samples.
      const bool is_mended = refused_ != nullptr && mends(report, *refused_);
      refused_ = report.contradicted ? &report : (is_mended ? nullptr : refused_);
    }
    const std::vector<ParameterEstimate> parameters = session.parameters();
    parameters_ = parameters.size();
    identified_ = static_cast<std::size_t>(
        std::count_if(parameters.begin(), parameters.end(), [](const ParameterEstimate& one) {
          return one.observable;
        }));
    if (identified_ > 0) {  // else there is nothing to judge
      judge_.emplace(session.heldOutJudge());
      if (!session.motionEvidence()) {  // which has samples of another time, or its own verdict
        earlier_judge_.emplace(session.heldOutJudge());
      }
      shortcoming_ = shortcoming(parameters);
      expected_errors_ = expectedErrors();
    }
  }

  GradedCalibration graded() {
    if (judge_) {
      const HeldOutValidation& validation = judge_->judge(session_.samples());
      validation_ = validation.samples > 0 ? &validation : nullptr;
      is_outdated_ = validation_ != nullptr && newestContradict(validation);
    }
    const Grade grade = this->grade();
    return {grade, reason(grade), grade == Grade::kContradicted && isContradicted()};
  }

  void settle() {
    if (judge_) {
      judge_->settle();
    }
  }

 private:
  Grade grade() const {
    if (identified_ == 0) {
      // Motion is one cycle for everything: where it does not fit, nothing else has a say.
      const bool is_motion = refused_ != nullptr && refused_->cycle == Cycle::kMotion;
      return is_motion ? Grade::kContradicted : Grade::kFailed;
    }
    if (refused_ != nullptr || isContradicted() || beginsContradicted()) {
      return Grade::kContradicted;
    }
    if (!isValidated()) {
      return Grade::kNotValidated;
    }
    return shortcoming_.empty() && undecided().empty() ? Grade::kGood : Grade::kUsable;
  }

  bool hasVerdict() const { return validation_ != nullptr && validation_->hasVerdict(); }

  bool isContradicted() const {
    return hasVerdict() && (validation_->probability < kLeastProbability || is_outdated_);
  }

  /// By what was held out when its description was made; nothing has changed or judged it since.
  bool beginsContradicted() const {
    const bool is_mended = last_success_ != nullptr && (last_success_->cycle != Cycle::kJoint ||
                                                        !session_.model().hasTorqueModel());
    return sac::isContradicted(session_.start()) && !is_mended && !isValidated();
  }

  /// Whether the newest held-out samples contradict, by all that those before them tell of the
  /// parameters, too: among many that agreed they would not show. What they add to the squared
  /// misfit of all is a chi-square of their own.
  bool newestContradict(const HeldOutValidation& all) {
    if (!earlier_judge_ || !takeEarlier()) {
      return false;
    }
    const HeldOutValidation& earlier = earlier_judge_->judge(earlier_);
    const double freedom = freedomOf(all) - freedomOf(earlier);
    const double chi_square =
        all.reduced_chi_square * freedomOf(all) - earlier.reduced_chi_square * freedomOf(earlier);
    return freedom > 0.0 &&
           chiSquareProbability(freedom, std::max(chi_square, 0.0)) < kLeastProbability;
  }

  /// All samples before the newest held-out ones; false where there are no others.
  bool takeEarlier() {
    const std::vector<Sample>& samples = session_.samples();
    std::size_t end = samples.size();
    for (std::size_t newest = 0; newest < kCheckedSamples && end > earlier_.size();) {
      newest += samples[--end].validation ? 1U : 0U;
    }
    earlier_.insert(earlier_.end(),
                    samples.begin() + static_cast<std::ptrdiff_t>(earlier_.size()),
                    samples.begin() + static_cast<std::ptrdiff_t>(end));
    return std::any_of(
        earlier_.begin(), earlier_.end(), [](const Sample& one) { return one.validation; });
  }

  static double freedomOf(const HeldOutValidation& validation) {
    return 3.0 * static_cast<double>(validation.residuals.size() - validation.unjudged_torques -
                                     validation.outliers);
  }

  /// Torques judge everything, orientations the joint only.
  bool isValidated() const {
    return hasVerdict() && (!isTorqueIdentified() || validation_->judgesCoils());
  }

  bool isTorqueIdentified() const {
    const ParameterSpace& space = session_.model().space();
    const auto first = session_.state().identified.begin();
    const auto last = first + space.effect();
    return std::find(first + space.pole(0), last, true) != last;
  }

  /// What keeps a calibration that held-out samples agree with from being good; empty: nothing.
  std::string shortcoming(const std::vector<ParameterEstimate>& parameters) const {
    // What is open says nothing of whether the rest is right.
    const std::string open = unidentified();
    const std::vector<std::string> doubts = doubtsInForce();
    const std::string doubt = doubts.empty() ? std::string() : ", but " + clause(doubts.front());
    if (!open.empty() || !doubt.empty()) {
      return open + doubt;
    }
    if (std::string missed = missedAccuracy(); !missed.empty()) {
      return missed;
    }
    if (isUnasked()) {
      return ", but no refinement asked all samples together whether something is not modelled: "
             "run refine";
    }
    if (isRegistrationRestated()) {
      return ", but registration has been stated otherwise since it was calibrated: its "
             "uncertainties are of before; calibrate again, by refine where torques serve";
    }
    const std::string confounded = confoundedRegistration(parameters);
    const bool used_torques = isTorqueIdentified() &&
                              (last_success_ == nullptr || last_success_->cycle != Cycle::kMotion);
    return confounded.empty()
               ? unstatedRegistrationInWords(session_.config().registration, used_torques)
               : confounded;
  }

  /// Of what held-out samples should judge, and do not.
  std::string undecided() const {
    return validation_ == nullptr || validation_->undecided_coils.empty()
               ? std::string()
               : ", but held-out torques of " + coilsInWords(validation_->undecided_coils) +
                     " are outliers alone: hold out others";
  }

  std::string unidentified() const {
    if (const std::vector<std::string> open = session_.openParameters(); !open.empty()) {
      return ", " + std::to_string(open.size()) + " that were asked for are not";
    }
    return identified_ < parameters_ ? ", the others are not" : "";
  }

  /// A sentence as a part of another one.
  static std::string clause(std::string sentence) {
    sentence.erase(sentence.find_last_not_of('.') + 1);
    if (!sentence.empty()) {
      sentence.front() =
          static_cast<char>(std::tolower(static_cast<unsigned char>(sentence.front())));
    }
    return sentence;
  }

  bool isRegistrationRestated() const {
    return last_success_ != nullptr && !last_success_->registration.empty() &&
           last_success_->registration != inWords(session_.config().registration);
  }

  /// Whether poles and coils were calibrated one after the other only: each cycle has few samples
  /// of its own, which tell little of what is not modelled.
  bool isUnasked() const {
    return isTorqueIdentified() && last_success_ != nullptr &&
           last_success_->cycle != Cycle::kRefine && last_success_->cycle != Cycle::kMotion;
  }

  /// Of the last successful cycle, and of those before it that it does not make up for.
  std::vector<std::string> doubtsInForce() const {
    std::vector<std::string> doubts;
    for (const CycleReport* report : unmended(session_.reports())) {
      if (report->success) {
        doubts.insert(doubts.end(), report->doubts.begin(), report->doubts.end());
      }
    }
    return doubts;
  }

  /// A registration that the samples find elsewhere than it is stated. Turning the marker or the
  /// force/torque sensor by opposite angles looks the same in all samples; which of both it was
  /// decides where joints and poles are.
  std::string confoundedRegistration(const std::vector<ParameterEstimate>& parameters) const {
    for (const auto& [found, other] :
         {std::pair{effect_name::kTorqueRegistration, effect_name::kMarkerRegistration},
          std::pair{effect_name::kMarkerRegistration, effect_name::kTorqueRegistration}}) {
      const EffectSelection& effects = session_.config().effects;
      if (!effects[found] || effects.stddev(found) > 0.0 || effects[other]) {
        continue;
      }
      double square = 0.0;
      double variance = 0.0;
      bool is_significant = false;
      for (const ParameterEstimate& one : parameters) {
        if (one.name.rfind(found, 0) == 0 && one.observable) {
          square += one.value * one.value;
          variance = std::max(variance, one.stddev * one.stddev);
          is_significant = is_significant || std::abs(one.value) > kSignificant * one.stddev;
        }
      }
      if (is_significant) {
        return format(
            ", but %s came out as %.3g ± %.1g mrad, and %s of as much would explain the samples as "
            "well, with joints and poles elsewhere by that: find out which of both registrations "
            "is wrong, and correct it",
            found,
            1e3 * std::sqrt(square),
            1e3 * std::sqrt(variance),
            other);
      }
    }
    return {};
  }

  std::string missedAccuracy() const {
    const WantedAccuracy& wanted = session_.config().wanted;
    if (last_success_ == nullptr) {
      return {};
    }
    if (wanted.orientation > 0.0 && session_.expectedErrors().orientation > wanted.orientation) {
      return format(", but the expected orientation error is above the wanted %.2g mrad",
                    1e3 * wanted.orientation);
    }
    if (wanted.torque > 0.0 && session_.expectedErrors().torque > wanted.torque) {
      return format(", but the expected torque error is above the wanted %.2g mN.m per ampere",
                    1e3 * wanted.torque);
    }
    return {};
  }

  std::string reason(Grade grade) const {
    switch (grade) {
      case Grade::kFailed:
        return session_.reports().empty() ? "Nothing is calibrated: no cycle was run."
                                          : "Nothing is calibrated: no cycle succeeded.";
      case Grade::kContradicted:
        if (refused_ != nullptr || !isContradicted()) {
          return "Do not use this calibration: " +
                 (refused_ != nullptr ? refused_->message
                                      : "what was held out when its description was made "
                                        "contradicts it; calibrate anew, or hold out others.");
        }
        return "Do not use this calibration yet: " + identified() + ", but the " +
               (validation_->probability < kLeastProbability ? "" : "newest ") + heldOut() +
               " contradict them" + contradicting() + ".";
      case Grade::kNotValidated:
        return "The calibration is not validated: " + identified() + shortcoming_ + unjudged() +
               expected_errors_;
      case Grade::kUsable:
        return "The calibration can be used as far as it goes: " + identified() + undecided() +
               shortcoming_ + "; " + heldOut() + " agree" + outliers() + "." + expected_errors_;
      case Grade::kGood:
        break;
    }
    return "The calibration is good to use: " + identified() + ", and " + heldOut() + " agree" +
           outliers() + "." + expected_errors_;
  }

  std::string heldOut() const { return std::string("held-out ") + validation_->things(); }

  std::string contradicting() const {
    const std::vector<HeldOutGroup> groups = validation_->contradicting();
    return groups.empty() ? std::string() : ", by " + inWords(groups);
  }

  std::string outliers() const {
    return validation_ != nullptr && validation_->outliers > 0
               ? " but for " + std::to_string(validation_->outliers) +
                     " outliers, as rare as the others'"
               : std::string();
  }

  std::string unjudged() const {
    return hasVerdict() ? "; no held-out torque judges poles and coils."
                        : "; no held-out sample judges them.";
  }

  std::string identified() const {
    return identified_ == parameters_
               ? "all " + std::to_string(parameters_) + " parameters are identified"
               : std::to_string(identified_) + " of " + std::to_string(parameters_) +
                     " parameters are identified";
  }

  /// Of the last successful cycle; a description that was calibrated before tells none.
  std::string expectedErrors() const {
    if (last_success_ == nullptr) {
      return {};
    }
    const CalibrationModel& model = session_.model();
    std::string text = " Expected error over the workspace:";
    if (model.space().joints() > 0) {
      text += format(" orientation %.2g mrad", 1e3 * session_.expectedErrors().orientation);
      text += model.hasTorqueModel() ? "," : "";
    }
    if (model.hasTorqueModel()) {
      text += format(" torque %.2g mN.m per ampere", 1e3 * session_.expectedErrors().torque);
    }
    return text + " (1 sigma, 95 % of all poses are better).";
  }

  const CalibrationSession& session_;
  std::size_t parameters_ = 0;
  std::size_t identified_ = 0;
  std::string shortcoming_;      ///< see shortcoming()
  std::string expected_errors_;  ///< see expectedErrors()
  std::optional<HeldOutJudge> judge_;
  const HeldOutValidation* validation_ = nullptr;  ///< of judge_; null: none was held out
  std::optional<HeldOutJudge> earlier_judge_;      ///< of earlier_
  std::vector<Sample> earlier_;
  bool is_outdated_ = false;
  const CycleReport* last_success_ = nullptr;
  const CycleReport* refused_ = nullptr;
};

CalibrationGrader::CalibrationGrader(const CalibrationSession& session)
    : examiner_(std::make_unique<Examiner>(session)) {}

CalibrationGrader::~CalibrationGrader() = default;
CalibrationGrader::CalibrationGrader(CalibrationGrader&& other) noexcept = default;
CalibrationGrader& CalibrationGrader::operator=(CalibrationGrader&& other) noexcept = default;

GradedCalibration CalibrationGrader::grade() {
  return examiner_->graded();
}

void CalibrationGrader::settle() {
  examiner_->settle();
}

std::string gradeName(Grade grade) {
  switch (grade) {
    case Grade::kGood:
      return "good";
    case Grade::kUsable:
      return "usable";
    case Grade::kNotValidated:
      return "not_validated";
    case Grade::kContradicted:
      return "contradicted";
    case Grade::kFailed:
      break;
  }
  return "failed";
}

bool isSound(Grade grade) {
  return grade != Grade::kContradicted && grade != Grade::kFailed;
}

GradedCalibration gradeCalibration(const CalibrationSession& session) {
  return CalibrationGrader(session).grade();
}

CalibratedDescription gradedDescription(const CalibrationSession& session,
                                        const CalibrationOrigin& origin,
                                        const GradedCalibration& graded) {
  CalibratedDescription result = session.description(origin);
  if (graded.held_out_contradicts && result.calibration->validation) {
    result.calibration->validation->contradicted = true;
  }
  return result;
}

}  // namespace sac
