#include "spherical_actuator_calibration/calibration/held_out_judge.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "held_out_groups.hpp"
#include "held_out_outliers.hpp"
#include "linear_coils.hpp"
#include "repeated_observations.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/same_dwell.hpp"
#include "spherical_actuator_calibration/estimation/sequential_update.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"
#include "told_coils.hpp"

namespace sac {
namespace {

SampleResidual residualOf(const Sample& sample,
                          Quantity quantity,
                          const Eigen::Vector3d& residual,
                          const Eigen::Matrix3d& covariance) {
  SampleResidual result;
  result.id = sample.id;
  result.quantity = quantity;
  result.residual = residual.norm();
  result.standardized = std::sqrt(residual.dot(Cholesky3(covariance).solve(residual)) / 3.0);
  return result;
}

double rootMean(double sum, std::size_t count) {
  return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

/// Takes one measurement after the other, then judges all together.
class HeldOutJudge::Judgement {
 public:
  Judgement(const CalibrationModel& model,
            const CalibrationState& state,
            const EstimationOptions& options,
            UsualOutliers outliers)
      : options_(options),
        usual_(std::move(outliers)),
        linear_coils_(linearCoils(model.space(), state.belief, state.identified)),
        point_(model, state.belief.x),
        all_(ChosenCoordinates::all(model.space().size())),
        every_(static_cast<std::size_t>(all_.size()), true),
        repeats_(options) {
    problem_.model = &model;
    problem_.prior = state.belief;
  }

  void join(HeldOutValidation other, bool alone) {
    other_ = std::move(other);
    is_other_alone_ = alone;
  }

  const HeldOutValidation& judge(const std::vector<Sample>& samples) {
    if (is_other_alone_) {
      return *other_;
    }
    const HeldOutValidation& of_samples = judgeSamples(samples);
    if (other_) {
      result_.has_windows_beside = other_->torques > 0;
      other_->undecided_coils = of_samples.undecided_coils;
    }
    return other_ ? severer(of_samples, *other_) : of_samples;
  }

  void settle() {
    if (update_) {
      update_->settle();
    }
  }

 private:
  const HeldOutValidation& judgeSamples(const std::vector<Sample>& samples) {
    // Without one that is held out, those in use need not be taken.
    for (; seen_ < samples.size() && !is_any_; ++seen_) {
      is_any_ = samples[seen_].validation;
    }
    if (!is_any_) {
      return result_;
    }
    if (changesTrackerNoise(samples) || !take(samples)) {
      beginAnew();
      take(samples);
    }
    if (!judged_.empty()) {
      conclude();
    }
    return result_;
  }

  /// Whether new samples in use change what an orientation map leaves open of those before. Those
  /// that are held out have no part in it, so that each of them is looked at once.
  bool changesTrackerNoise(const std::vector<Sample>& samples) {
    constexpr double kRounding = 1e-9;
    const double before = tracker_.variance();
    for (std::size_t n = taken_; n < samples.size() && problem_.model->hasOrientationMap(); ++n) {
      if (!samples[n].validation) {
        tracker_.add(samples[n], options_);
      }
    }
    return !judged_.empty() && std::abs(tracker_.variance() - before) > kRounding * before;
  }

  void beginAnew() {
    taken_ = 0;
    observations_.clear();
    held_out_.clear();
    repeats_ = RepeatSearch(options_);
    dwell_.reset();
    dwells_ = 0;
    judged_.clear();
    groups_ = HeldOutGroups();
    in_use_.clear();
    update_.reset();
    result_ = HeldOutValidation();
  }

  /// Those in use first: it is the held-out ones that repeat them. False where one in use repeats a
  /// held-out one that was taken before it.
  bool take(const std::vector<Sample>& samples) {
    problem_.samples = &samples;
    for (const bool held_out : {false, true}) {
      for (std::size_t n = taken_; n < samples.size(); ++n) {
        if (samples[n].validation == held_out && !takeSample(n, held_out)) {
          return false;
        }
      }
    }
    taken_ = samples.size();
    return true;
  }

  bool takeSample(std::size_t n, bool held_out) {
    const Sample& sample = (*problem_.samples)[n];
    const CalibrationModel& model = *problem_.model;
    if (held_out) {
      validate(sample, model.space().coils());
      ++result_.samples;
    } else {
      noteInUse(n);
    }
    if (model.observesOrientation(sample) &&
        !takeObservation({n, Quantity::kOrientation}, held_out)) {
      return false;
    }
    return !sample.has_torque || !model.hasTorqueModel() ||
           excitedCoils(sample, options_.current_threshold).empty() ||
           takeObservation({n, Quantity::kTorque}, held_out);
  }

  /// Where a cycle has looked at it.
  void noteInUse(std::size_t n) {
    const Sample& sample = (*problem_.samples)[n];
    const auto looked_at = usual_.torques.find(sample.id);
    if (looked_at == usual_.torques.end()) {
      return;
    }
    for (const std::size_t coil : coilsOn(sample, options_.current_threshold)) {
      TorquesInUse& torques = in_use_[coil];
      if (looked_at->second) {
        torques.rejected.push_back(n);
      } else {
        torques.last_agreeing = n;
      }
    }
  }

  bool takeObservation(const Observation& observation, bool held_out) {
    observations_.push_back(observation);
    held_out_.push_back(held_out);
    const std::optional<std::size_t> earlier = repeats_.add(*problem_.samples, observations_);
    if (held_out) {
      look(observation, earlier.has_value());
    }
    return held_out || !earlier || !held_out_[*earlier];
  }

  /// Lists a held-out observation with its own misfit.
  void look(const Observation& observation, bool is_repeated) {
    const Sample& sample = (*problem_.samples)[observation.sample];
    problem_.observations = {observation};
    const ObservationEvaluator evaluator(problem_, options_, tracker_);
    evaluator.linearize(0, point_, linear_);
    const SampleResidual residual = residualOf(
        sample, observation.quantity, linear_.residual, evaluator.covariance(0, linear_, every_));
    joinDwell(sample);
    if (is_repeated && residual.standardized > kNoNoise) {
      ++result_.repeated;
      return;
    }
    HeldOutMeasurement one;
    one.quantity = observation.quantity;
    one.sample = observation.sample;
    if (one.quantity == Quantity::kTorque) {
      one.coils = coilsOn(sample, options_.current_threshold);
    }
    one.counts = std::all_of(
        one.coils.begin(), one.coils.end(), [this](std::size_t j) { return linear_coils_[j]; });
    one.dwell = dwells_;
    one.squared_norm = linear_.residual.squaredNorm();
    if (one.counts) {
      whitenJudged(evaluator, one);
    }
    result_.unjudged_torques += one.counts ? 0U : 1U;
    judged_.push_back(std::move(one));
    result_.residuals.push_back(residual);
  }

  /// Samples without shared errors are dwells of their own.
  void joinDwell(const Sample& sample) {
    const bool shares = options_.shared_errors && hasSharedErrors(sample, *problem_.model);
    if (!shares || !dwell_ || !isSameDwell(*dwell_, sample)) {
      ++dwells_;
      dwell_ = shares ? std::optional<Sample>(sample) : std::nullopt;
    }
  }

  void whitenJudged(const ObservationEvaluator& evaluator, HeldOutMeasurement& one) const {
    const Eigen::Matrix3d W =
        whiteningOf(dwell_ ? evaluator.ownNoise(0, linear_) : evaluator.noise(0, linear_));
    whiten(linear_, W, all_, one.misfit);
    one.whitening = W;
    if (dwell_) {
      one.loading = W * evaluator.sharedErrors(0, linear_);
    }
  }

  void conclude() {
    const OutlierChoice choice = setOutliersAside();
    addMisfits();
    const std::size_t judged =
        result_.residuals.size() - result_.unjudged_torques - result_.outliers;
    if (judged > 0) {
      const auto values = 3.0 * static_cast<double>(judged);
      const double chi_square = std::max(update_->chiSquare(), 0.0);
      result_.reduced_chi_square = chi_square / values;
      result_.probability = chiSquareProbability(values, chi_square);
    }
    result_.groups = groups_.judge(judged_, choice, problem_.prior.covariance);
    const auto among = static_cast<double>(result_.groups.size() + 1);
    for (const HeldOutGroup& group : result_.contradicting()) {
      result_.probability = std::min(result_.probability, among * group.probability());
    }
  }

  /// Marks what stands out as rejected, where it is no more than elsewhere.
  OutlierChoice setOutliersAside() {
    OutlierChoice choice =
        chooseOutliers(judged_, outliers(), in_use_, usual_.rate, options_.max_rejected_fraction);
    result_.outliers = choice.count;
    result_.undecided_coils = choice.undecided_coils;
    result_.doubtful_coils = choice.doubtful_coils;
    const std::vector<bool>& is_rejected = choice.set_aside;
    for (std::size_t n = 0; n < judged_.size(); ++n) {
      SampleResidual& residual = result_.residuals[n];
      if (residual.rejected == is_rejected[n]) {
        continue;
      }
      residual.rejected = is_rejected[n];
      residual.reason = is_rejected[n]
                            ? format("misfit is %.1f times its uncertainty", residual.standardized)
                            : std::string();
      if (n < added_) {  // what is in the sum cannot be taken out of it, nor come before its end
        update_.reset();
      }
    }
    return choice;
  }

  /// Those that stand out by themselves, ascending.
  std::vector<std::size_t> outliers() const {
    const double limit =
        chiSquareLimit(3.0,
                       options_.false_alarm_probability /
                           static_cast<double>(std::max<std::size_t>(1, judged_.size())));
    std::vector<std::size_t> outliers;
    for (std::size_t n = 0; n < judged_.size(); ++n) {
      const double standardized = result_.residuals[n].standardized;
      if (3.0 * standardized * standardized > limit && judged_[n].counts) {
        outliers.push_back(n);
      }
    }
    return outliers;
  }

  /// To the test, those that are new; all of them where others are rejected than before.
  void addMisfits() {
    if (!update_) {
      update_.emplace(problem_.prior.covariance);
      added_ = 0;
      added_dwell_ = 0;
      orientation_squares_ = 0.0;
      torque_squares_ = 0.0;
      result_.orientations = 0;
      result_.torques = 0;
      told_ = ToldCoils();
    }
    for (; added_ < judged_.size(); ++added_) {
      if (!result_.residuals[added_].rejected) {
        addMisfit(judged_[added_]);
      }
    }
    result_.told_coils = told_.coils();
    result_.orientation_rms = rootMean(orientation_squares_, result_.orientations);
    result_.torque_rms = rootMean(torque_squares_, result_.torques);
  }

  void addMisfit(const HeldOutMeasurement& one) {
    const bool is_orientation = one.quantity == Quantity::kOrientation;
    (is_orientation ? result_.orientations : result_.torques) += 1;
    (is_orientation ? orientation_squares_ : torque_squares_) += one.squared_norm;
    if (!one.counts) {
      return;
    }
    told_.add(one, problem_.model->space());
    if (one.dwell != added_dwell_) {
      update_->beginDwell();
      added_dwell_ = one.dwell;
    }
    update_->observe(one.misfit, one.loading);
  }

  const EstimationOptions options_;
  const UsualOutliers usual_;
  const std::vector<bool> linear_coils_;
  const ModelPoint point_;  ///< the model at the state
  const ChosenCoordinates all_;
  const std::vector<bool> every_;  ///< coordinate is uncertain by the prior
  EstimationProblem problem_;      ///< of the observation at hand

  std::size_t seen_ = 0;                   ///< of the samples, until one is held out
  bool is_any_ = false;                    ///< held out
  std::size_t taken_ = 0;                  ///< of the samples
  std::vector<Observation> observations_;  ///< in use or held out
  std::vector<bool> held_out_;             ///< per observation
  TrackerNoise tracker_;                   ///< of the samples in use
  RepeatSearch repeats_;
  std::optional<Sample> dwell_;  ///< the first sample of the present one, where it shares errors
  std::size_t dwells_ = 0;
  std::vector<HeldOutMeasurement> judged_;  ///< in the order of the residuals
  HeldOutGroups groups_;
  std::map<std::size_t, TorquesInUse> in_use_;  ///< by coil

  std::optional<SequentialUpdate> update_;  ///< the first added_ of judged_ that are not rejected
  std::size_t added_ = 0;
  std::size_t added_dwell_ = 0;
  ToldCoils told_;
  double orientation_squares_ = 0.0;
  double torque_squares_ = 0.0;

  HeldOutValidation result_;
  std::optional<HeldOutValidation> other_;
  bool is_other_alone_ = false;
  LinearizedObservation linear_;  // storage that is reused
};

HeldOutJudge::HeldOutJudge(const CalibrationModel& model,
                           const CalibrationState& state,
                           const EstimationOptions& options,
                           UsualOutliers outliers)
    : judgement_(std::make_unique<Judgement>(model, state, options, std::move(outliers))) {}

HeldOutJudge::~HeldOutJudge() = default;
HeldOutJudge::HeldOutJudge(HeldOutJudge&& other) noexcept = default;
HeldOutJudge& HeldOutJudge::operator=(HeldOutJudge&& other) noexcept = default;

void HeldOutJudge::join(HeldOutValidation other, bool alone) {
  judgement_->join(std::move(other), alone);
}

const HeldOutValidation& HeldOutJudge::judge(const std::vector<Sample>& samples) {
  return judgement_->judge(samples);
}

void HeldOutJudge::settle() {
  judgement_->settle();
}

HeldOutValidation validateHeldOut(const CalibrationModel& model,
                                  const std::vector<Sample>& samples,
                                  const CalibrationState& state,
                                  const EstimationOptions& options,
                                  const UsualOutliers& outliers) {
  return HeldOutJudge(model, state, options, outliers).judge(samples);
}

}  // namespace sac
