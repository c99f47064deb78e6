#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <boost/math/distributions/chi_squared.hpp>

#include "spherical_actuator_calibration/base/text_format.hpp"
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
    if (samples[n].has_orientation) {
      problem.observations.push_back({n, Quantity::kOrientation});
    }
    if (samples[n].has_torque && model.hasTorqueModel() &&
        !excitedCoils(samples[n], options.current_threshold).empty()) {
      problem.observations.push_back({n, Quantity::kTorque});
    }
  }
  return problem;
}

/// Squared Mahalanobis norm of all residuals r of a sum. Their covariance is N + J P Jᵀ with
/// block-diagonal noise N and P = L Lᵀ of the coordinates; its inverse by Woodbury's identity.
double jointChiSquare(const InformationSum& sum, const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(covariance);
  const Eigen::MatrixXd root =
      spectrum.eigenvectors() * spectrum.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  Eigen::MatrixXd inner = root.transpose() * sum.information() * root;
  inner.diagonal().array() += 1.0;
  const Eigen::VectorXd projected = root.transpose() * sum.gradient();
  return sum.squaredMisfit() - projected.dot(inner.llt().solve(projected));
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

}  // namespace

HeldOutValidation validateHeldOut(const CalibrationModel& model,
                                  const std::vector<Sample>& samples,
                                  const CalibrationState& state,
                                  const EstimationOptions& options) {
  const ParameterBelief& belief = state.belief;
  const EstimationProblem problem = heldOutProblem(model, samples, belief, options);
  const ObservationEvaluator evaluator(problem, options);
  const std::vector<bool> all_held(static_cast<std::size_t>(model.space().size()), true);
  HeldOutValidation result;
  for (const Sample& sample : samples) {
    result.samples += sample.validation ? 1U : 0U;
  }
  if (problem.observations.empty()) {
    return result;
  }
  double orientation_sum = 0.0;
  double torque_sum = 0.0;
  const ChosenCoordinates all = ChosenCoordinates::all(model.space().size());
  InformationSum misfit(all.size());
  const SharedErrorModel shared = groupByDwell(problem, options);
  std::map<std::size_t, WhitenedObservation> sharing;  ///< judged ones of dwells
  std::map<std::size_t, SharedLoading> loading;
  WhitenedObservation whitened;
  LinearizedObservation linear;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    const auto [sample, quantity] = problem.observations[n];
    evaluator.linearize(n, belief.x, linear);
    if (isJudged(problem.observations[n],
                 samples[sample],
                 model.space(),
                 state.identified,
                 options.current_threshold)) {
      const Eigen::Matrix3d noise =
          shared.shares[n] ? evaluator.ownNoise(n) : evaluator.noise(n, linear);
      const Eigen::Matrix3d whitening = whiteningOf(noise);
      whiten(linear, whitening, all, whitened);
      if (shared.shares[n]) {
        sharing[n] = whitened;
        loading[n] = whitening * evaluator.sharedErrors(n, linear);
      } else {
        misfit.add(whitened);
      }
    } else {
      ++result.unjudged_torques;
    }
    result.residuals.push_back(residualOf(
        samples[sample], quantity, linear.residual, evaluator.covariance(n, linear, all_held)));
    const bool is_orientation = quantity == Quantity::kOrientation;
    (is_orientation ? result.orientations : result.torques) += 1;
    (is_orientation ? orientation_sum : torque_sum) += linear.residual.squaredNorm();
  }
  addDwells(shared, sharing, loading, misfit);
  result.orientation_rms = rootMean(orientation_sum, result.orientations);
  result.torque_rms = rootMean(torque_sum, result.torques);
  const std::size_t judged = problem.observations.size() - result.unjudged_torques;
  if (judged == 0) {
    return result;
  }
  const auto values = 3.0 * static_cast<double>(judged);
  const double chi_square = std::max(jointChiSquare(misfit, belief.covariance), 0.0);
  result.reduced_chi_square = chi_square / values;
  const boost::math::chi_squared_distribution<double> distribution(values);
  result.probability = boost::math::cdf(boost::math::complement(distribution, chi_square));
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
