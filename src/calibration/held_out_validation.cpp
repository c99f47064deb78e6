#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "cycle_conclusion.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"
#include "spherical_actuator_calibration/estimation/joint_chi_square.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

EstimationProblem heldOutProblem(const CalibrationModel& model,
                                 const std::vector<Sample>& samples,
                                 const ParameterBelief& belief,
                                 const EstimationOptions& options) {
  EstimationProblem problem;
  problem.model = &model;
  problem.samples = &samples;
  problem.prior = belief;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (!samples[n].validation) {
      continue;
    }
    validate(samples[n], model.space().coils());
    if (model.observesOrientation(samples[n])) {
      problem.observations.push_back({n, Quantity::kOrientation});
    }
    if (samples[n].has_torque && model.hasTorqueModel() &&
        !excitedCoils(samples[n], options.current_threshold).empty()) {
      problem.observations.push_back({n, Quantity::kTorque});
    }
  }
  return problem;
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

/// Whether the test counts an observation: not with coils that nothing has identified.
bool isJudged(const Observation& observation,
              const Sample& sample,
              const ParameterSpace& space,
              const std::vector<bool>& identified,
              double current_threshold) {
  if (observation.quantity == Quantity::kOrientation) {
    return true;
  }
  const std::vector<Excitation> excitations = excitedCoils(sample, current_threshold);
  return std::all_of(excitations.begin(), excitations.end(), [&](const Excitation& excitation) {
    return identified[static_cast<std::size_t>(space.coil(excitation.coil))];
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
               const EstimationOptions& options)
      : problem_(problem),
        state_(state),
        options_(options),
        evaluator_(problem, options),
        point_(evaluator_.at(state.belief.x)),
        shared_(groupByDwell(problem, options)),
        all_(ChosenCoordinates::all(problem.model->space().size())),
        misfit_(all_.size()) {}

  void judge(HeldOutValidation& result) {
    for (std::size_t n = 0; n < problem_.observations.size(); ++n) {
      take(n, result);
    }
    addDwells(shared_, sharing_, loading_, misfit_);
    result.orientation_rms = rootMean(orientation_sum_, result.orientations);
    result.torque_rms = rootMean(torque_sum_, result.torques);
    const std::size_t judged = problem_.observations.size() - result.unjudged_torques;
    if (judged > 0) {
      conclude(judged, result);
    }
  }

 private:
  void take(std::size_t n, HeldOutValidation& result) {
    const auto [index, quantity] = problem_.observations[n];
    const Sample& sample = (*problem_.samples)[index];
    evaluator_.linearize(n, point_, linear_);
    if (isJudged(problem_.observations[n],
                 sample,
                 problem_.model->space(),
                 state_.identified,
                 options_.current_threshold)) {
      whitenJudged(n);
    } else {
      ++result.unjudged_torques;
    }
    const std::vector<bool> all_held(static_cast<std::size_t>(all_.size()), true);
    result.residuals.push_back(residualOf(
        sample, quantity, linear_.residual, evaluator_.covariance(n, linear_, all_held)));
    const bool is_orientation = quantity == Quantity::kOrientation;
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
  ObservationEvaluator evaluator_;
  ModelPoint point_;  ///< the model at the state
  SharedErrorModel shared_;
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
                                  const EstimationOptions& options) {
  HeldOutValidation result;
  for (const Sample& sample : samples) {
    result.samples += sample.validation ? 1U : 0U;
  }
  const EstimationProblem problem = heldOutProblem(model, samples, state.belief, options);
  if (!problem.observations.empty()) {
    HeldOutJudge(problem, state, options).judge(result);
  }
  return result;
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
