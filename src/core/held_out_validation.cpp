#include "spherical_actuator_calibration/core/held_out_validation.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "spherical_actuator_calibration/core/linearization.hpp"

namespace spherical_actuator_calibration {
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

double rootMean(double sum, std::size_t count) {
  return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

HeldOutValidation validateHeldOut(const CalibrationModel& model,
                                  const std::vector<Sample>& samples,
                                  const ParameterBelief& belief,
                                  const EstimationOptions& options) {
  const EstimationProblem problem = heldOutProblem(model, samples, belief, options);
  const ObservationEvaluator evaluator(problem, options);
  const std::vector<bool> all_held(static_cast<std::size_t>(model.space().size()), true);
  HeldOutValidation result;
  for (const Sample& sample : samples) {
    result.samples += sample.validation ? 1U : 0U;
  }
  double orientation_sum = 0.0;
  double torque_sum = 0.0;
  double chi_square = 0.0;
  LinearizedObservation linear;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    evaluator.linearize(n, belief.x, linear);
    const Eigen::Matrix3d covariance = evaluator.covariance(n, linear, all_held);
    chi_square += linear.residual.dot(covariance.llt().solve(linear.residual));
    const bool is_orientation = problem.observations[n].quantity == Quantity::kOrientation;
    (is_orientation ? result.orientations : result.torques) += 1;
    (is_orientation ? orientation_sum : torque_sum) += linear.residual.squaredNorm();
  }
  result.orientation_rms = rootMean(orientation_sum, result.orientations);
  result.torque_rms = rootMean(torque_sum, result.torques);
  const std::size_t values = 3 * problem.observations.size();
  result.reduced_chi_square = values == 0 ? 0.0 : chi_square / static_cast<double>(values);
  return result;
}

}  // namespace spherical_actuator_calibration
