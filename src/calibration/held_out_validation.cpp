#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include <boost/math/distributions/binomial.hpp>

#include "cycle_conclusion.hpp"
#include "repeated_observations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"
#include "spherical_actuator_calibration/estimation/joint_chi_square.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

/// Orientations and torques of samples that are held out, or of those in use.
std::vector<Observation> observationsOf(const CalibrationModel& model,
                                        const std::vector<Sample>& samples,
                                        const EstimationOptions& options,
                                        bool held_out) {
  std::vector<Observation> observations;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (samples[n].validation != held_out) {
      continue;
    }
    if (model.observesOrientation(samples[n])) {
      observations.push_back({n, Quantity::kOrientation});
    }
    if (samples[n].has_torque && model.hasTorqueModel() &&
        !excitedCoils(samples[n], options.current_threshold).empty()) {
      observations.push_back({n, Quantity::kTorque});
    }
  }
  return observations;
}

EstimationProblem heldOutProblem(const CalibrationModel& model,
                                 const std::vector<Sample>& samples,
                                 const ParameterBelief& belief,
                                 const EstimationOptions& options) {
  EstimationProblem problem;
  problem.model = &model;
  problem.samples = &samples;
  problem.prior = belief;
  for (const Sample& sample : samples) {
    if (sample.validation) {
      validate(sample, model.space().coils());
    }
  }
  problem.observations = observationsOf(model, samples, options, true);
  return problem;
}

/// Per held-out observation: it repeats another one, held out or in use.
std::vector<bool> repeatedOf(const EstimationProblem& problem, const EstimationOptions& options) {
  std::vector<Observation> all = observationsOf(*problem.model, *problem.samples, options, false);
  const std::size_t used = all.size();
  all.insert(all.end(), problem.observations.begin(), problem.observations.end());
  std::vector<bool> repeated(problem.observations.size(), false);
  for (const RepeatedObservation& one : repeatedObservations(*problem.samples, all, options)) {
    if (one.place >= used) {
      repeated[one.place - used] = true;
    }
  }
  return repeated;
}

/// Whether so many outliers among `count` are no more than the rate of those elsewhere.
bool areUsual(std::size_t outliers, std::size_t count, double rate, double most) {
  if (outliers == 0 || static_cast<double>(outliers) > most * static_cast<double>(count)) {
    return outliers == 0;
  }
  const boost::math::binomial_distribution<double> usual(static_cast<double>(count), rate);
  return boost::math::cdf(boost::math::complement(usual, static_cast<double>(outliers) - 1.0)) >=
         kLeastProbability;
}

SampleResidual residualOf(const Sample& sample,
                          Quantity quantity,
                          const Eigen::Vector3d& residual,
                          const Eigen::Matrix3d& covariance) {
  SampleResidual result;
  result.id = sample.id;
  result.quantity = quantity;
  result.residual = residual.norm();
  result.standardized = std::sqrt(residual.dot(covariance.llt().solve(residual)) / 3.0);
  return result;
}

/// Whether a torque is close to linear over the uncertainty of a coil's axis: its angles are
/// identified, and known to a small part of the width of the torque curve's peak.
bool isLinear(const CalibrationState& state, Eigen::Index coil) {
  constexpr double kMostStddev = 0.01;  // [rad]
  const auto first = static_cast<std::size_t>(coil);
  const double variance = state.belief.covariance.block<2, 2>(coil, coil).trace();
  return state.identified[first] && state.identified[first + 1] &&
         variance < kMostStddev * kMostStddev;
}

/// Whether the test counts an observation.
bool isJudged(const Observation& observation,
              const Sample& sample,
              const ParameterSpace& space,
              const CalibrationState& state,
              double current_threshold) {
  if (observation.quantity == Quantity::kOrientation) {
    return true;
  }
  const std::vector<Excitation> excitations = excitedCoils(sample, current_threshold);
  return std::all_of(excitations.begin(), excitations.end(), [&](const Excitation& excitation) {
    return isLinear(state, space.coil(excitation.coil));
  });
}

/// Adds what observations of dwells tell beside the errors that they share.
void addDwells(const SharedErrorModel& shared,
               const std::map<std::size_t, WhitenedObservation>& sharing,
               const std::map<std::size_t, SharedLoading>& loading,
               InformationSum& misfit) {
  DwellSum sum(misfit.gradient().size());
  for (const std::vector<std::size_t>& dwell : shared.dwells) {
    sum.begin();
    for (const std::size_t n : dwell) {
      const auto found = sharing.find(n);
      if (found != sharing.end()) {
        sum.add(found->second, loading.at(n));
      }
    }
    sum.addTo(misfit);
  }
}

double rootMean(double sum, std::size_t count) {
  return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

/// Judges one measurement after the other, then all together.
class HeldOutJudge {
 public:
  HeldOutJudge(const EstimationProblem& problem,
               const CalibrationState& state,
               const EstimationOptions& options,
               double outlier_rate)
      : problem_(problem),
        state_(state),
        options_(options),
        outlier_rate_(outlier_rate),
        evaluator_(problem, options),
        point_(evaluator_.at(state.belief.x)),
        shared_(groupByDwell(problem, options)),
        repeated_(repeatedOf(problem, options)),
        all_(ChosenCoordinates::all(problem.model->space().size())),
        misfit_(all_.size()) {}

  void judge(HeldOutValidation& result) {
    for (std::size_t n = 0; n < problem_.observations.size(); ++n) {
      look(n, result);
    }
    setOutliersAside(result);
    for (const Judged& one : judged_) {
      take(one, result);
    }
    addDwells(shared_, sharing_, loading_, misfit_);
    result.orientation_rms = rootMean(orientation_sum_, result.orientations);
    result.torque_rms = rootMean(torque_sum_, result.torques);
    const std::size_t judged = result.residuals.size() - result.unjudged_torques - result.outliers;
    if (judged > 0) {
      conclude(judged, result);
    }
  }

 private:
  /// One observation and its place among the residuals of the result.
  struct Judged {
    std::size_t observation;
    std::size_t residual;
    bool counts;  ///< in the test
  };

  /// Lists an observation with its own misfit.
  void look(std::size_t n, HeldOutValidation& result) {
    constexpr double kNoNoise = 1e-3;  // standardised: of a simulation, which honestly repeats
    const auto [index, quantity] = problem_.observations[n];
    const Sample& sample = (*problem_.samples)[index];
    evaluator_.linearize(n, point_, linear_);
    const std::vector<bool> all_held(static_cast<std::size_t>(all_.size()), true);
    const SampleResidual residual =
        residualOf(sample, quantity, linear_.residual, evaluator_.covariance(n, linear_, all_held));
    if (repeated_[n] && residual.standardized > kNoNoise) {
      ++result.repeated;
      return;
    }
    const bool counts = isJudged(problem_.observations[n],
                                 sample,
                                 problem_.model->space(),
                                 state_,
                                 options_.current_threshold);
    result.unjudged_torques += counts ? 0U : 1U;
    judged_.push_back({n, result.residuals.size(), counts});
    result.residuals.push_back(residual);
  }

  /// Marks what stands out as rejected, where it is no more than elsewhere.
  void setOutliersAside(HeldOutValidation& result) const {
    const double limit =
        chiSquareLimit(3.0,
                       options_.false_alarm_probability /
                           static_cast<double>(std::max<std::size_t>(1, judged_.size())));
    std::vector<std::size_t> outliers;
    std::size_t count = 0;
    for (const Judged& one : judged_) {
      count += one.counts ? 1U : 0U;
      const double standardized = result.residuals[one.residual].standardized;
      if (one.counts && 3.0 * standardized * standardized > limit) {
        outliers.push_back(one.residual);
      }
    }
    if (!areUsual(outliers.size(), count, outlier_rate_, options_.max_rejected_fraction)) {
      return;
    }
    result.outliers = outliers.size();
    for (const std::size_t n : outliers) {
      SampleResidual& residual = result.residuals[n];
      residual.rejected = true;
      residual.reason = format("misfit is %.1f times its uncertainty", residual.standardized);
    }
  }

  void take(const Judged& one, HeldOutValidation& result) {
    if (result.residuals[one.residual].rejected) {
      return;
    }
    evaluator_.linearize(one.observation, point_, linear_);
    if (one.counts) {
      whitenJudged(one.observation);
    }
    const bool is_orientation =
        problem_.observations[one.observation].quantity == Quantity::kOrientation;
    (is_orientation ? result.orientations : result.torques) += 1;
    (is_orientation ? orientation_sum_ : torque_sum_) += linear_.residual.squaredNorm();
  }

  void whitenJudged(std::size_t n) {
    const bool is_shared = shared_.shares[n];
    const Eigen::Matrix3d whitening =
        whiteningOf(is_shared ? evaluator_.ownNoise(n, linear_) : evaluator_.noise(n, linear_));
    whiten(linear_, whitening, all_, whitened_);
    if (is_shared) {
      sharing_[n] = whitened_;
      loading_[n] = whitening * evaluator_.sharedErrors(n, linear_);
    } else {
      misfit_.add(whitened_);
    }
  }

  void conclude(std::size_t judged, HeldOutValidation& result) const {
    const auto values = 3.0 * static_cast<double>(judged);
    const double chi_square = std::max(jointChiSquare(misfit_.information(),
                                                      misfit_.gradient(),
                                                      misfit_.squaredMisfit(),
                                                      state_.belief.covariance),
                                       0.0);
    result.reduced_chi_square = chi_square / values;
    result.probability = chiSquareProbability(values, chi_square);
  }

  const EstimationProblem& problem_;
  const CalibrationState& state_;
  const EstimationOptions& options_;
  double outlier_rate_;
  ObservationEvaluator evaluator_;
  ModelPoint point_;  ///< the model at the state
  SharedErrorModel shared_;
  std::vector<bool> repeated_;  ///< per observation
  std::vector<Judged> judged_;
  ChosenCoordinates all_;
  InformationSum misfit_;
  std::map<std::size_t, WhitenedObservation> sharing_;  ///< judged ones of dwells
  std::map<std::size_t, SharedLoading> loading_;
  double orientation_sum_ = 0.0;
  double torque_sum_ = 0.0;
  // Storage that is reused.
  WhitenedObservation whitened_;
  LinearizedObservation linear_;
};

}  // namespace

HeldOutValidation validateHeldOut(const CalibrationModel& model,
                                  const std::vector<Sample>& samples,
                                  const CalibrationState& state,
                                  const EstimationOptions& options,
                                  double outlier_rate) {
  HeldOutValidation result;
  for (const Sample& sample : samples) {
    result.samples += sample.validation ? 1U : 0U;
  }
  const EstimationProblem problem = heldOutProblem(model, samples, state.belief, options);
  if (!problem.observations.empty()) {
    HeldOutJudge(problem, state, options, outlier_rate).judge(result);
  }
  return result;
}

double outlierRate(const CycleReport& report) {
  const auto rejected = std::count_if(
      report.residuals.begin(), report.residuals.end(), [](const SampleResidual& residual) {
        return residual.rejected;
      });
  const std::size_t count = std::max<std::size_t>(1, report.residuals.size());
  return static_cast<double>(rejected) / static_cast<double>(count);
}

HeldOutValidation validationOf(const HeldOutMotion& motion) {
  HeldOutValidation result;
  result.samples = motion.windows;
  result.torques = motion.windows;
  result.torque_rms = motion.torque_rms;
  result.orientations = motion.orientations;
  result.orientation_rms = motion.orientation_rms;
  result.reduced_chi_square = motion.reduced_chi_square;
  result.probability = motion.probability;
  for (const ObservationResidual& from : motion.residuals) {
    const auto id = static_cast<std::uint32_t>(from.observation.sample + 1);
    result.residuals.push_back(reportedResidual(from, id));
  }
  return result;
}

std::string verdict(const HeldOutValidation& validation) {
  if (!validation.hasVerdict() && validation.unjudged_torques > 0) {
    return "The held-out samples are torques of coils that are not calibrated: calibrate these "
           "first.";
  }
  if (!validation.hasVerdict()) {
    return "No held-out sample can judge: capture some poses with validation set.";
  }
  std::string text = format("%zu held-out samples:", validation.samples);
  if (validation.orientations > 0) {
    text += format(" orientation rms %.3g mrad,", 1e3 * validation.orientation_rms);
  }
  if (validation.torques > 0) {
    text += format(" torque rms %.3g mN.m,", 1e3 * validation.torque_rms);
  }
  if (validation.unjudged_torques > 0) {
    text += format(" %zu torques of coils that are not calibrated are not judged,",
                   validation.unjudged_torques);
  }
  if (validation.repeated > 0) {
    text += format(" %zu measurements that repeat others bit for bit are not judged,",
                   validation.repeated);
  }
  if (validation.outliers > 0) {
    text += format(" %zu outliers, no more than among the others, are not judged,",
                   validation.outliers);
  }
  text += format(" reduced chi-square %.3g (probability %.2g): ",
                 validation.reduced_chi_square,
                 validation.probability);
  if (validation.probability < kLeastProbability) {
    return text +
           "they contradict the parameters in force. Look at the largest standardized residuals; "
           "then calibrate again.";
  }
  return text + "they agree with the parameters within the stated uncertainties.";
}

}  // namespace sac
