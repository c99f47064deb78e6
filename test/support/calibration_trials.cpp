#include "support/calibration_trials.hpp"

#include <cmath>

#include <Eigen/LU>

#include "spherical_actuator_calibration/core/linearization.hpp"

namespace spherical_actuator_calibration {

Eigen::MatrixXd cramerRaoBound(const CalibrationModel& model,
                               const std::vector<Sample>& samples,
                               const CycleRequest& request,
                               const std::vector<Eigen::Index>& free,
                               const Eigen::VectorXd& truth) {
  const EstimationOptions options;
  EstimationProblem problem;
  problem.model = &model;
  problem.samples = &samples;
  problem.observations = selectObservations(samples, request, options);
  problem.prior.x = truth;
  problem.prior.covariance = Eigen::MatrixXd::Zero(truth.size(), truth.size());
  const ObservationEvaluator evaluator(problem, options);
  const auto count = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  LinearizedObservation linear;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    evaluator.linearize(n, truth, linear);
    const Sample& sample = samples[problem.observations[n].sample];
    const double stddev = problem.observations[n].quantity == Quantity::kOrientation
                              ? sample.orientation_stddev
                              : sample.torque_stddev;
    Eigen::MatrixXd J(3, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      J.col(k) = linear.jacobian.col(free[static_cast<std::size_t>(k)]);
    }
    information += J.transpose() * J / (stddev * stddev);
  }
  return information.inverse();
}

void TrialStatistics::add(const ParameterBelief& estimated,
                          const Eigen::VectorXd& truth,
                          const std::vector<Eigen::Index>& free,
                          const Eigen::MatrixXd& bound) {
  constexpr double kTwoSided95 = 1.959964;
  double squares = 0.0;
  for (const Eigen::Index p : free) {
    const double error = estimated.x[p] - truth[p];
    squares += error * error;
    covered_ += std::abs(error) <= kTwoSided95 * std::sqrt(estimated.covariance(p, p)) ? 1 : 0;
    ++parameters_;
  }
  const auto count = static_cast<double>(free.size());
  squared_error_ += squares / count;
  squared_bound_ += bound.trace() / count;
  rms_error_ += std::sqrt(squares / count);
  rms_bound_ += std::sqrt(bound.trace() / count);
}

double TrialStatistics::errorOverBound() const {
  return std::sqrt(squared_error_ / squared_bound_);
}

double TrialStatistics::meanErrorOverBound() const {
  return rms_error_ / rms_bound_;
}

double TrialStatistics::coverage() const {
  return static_cast<double>(covered_) / static_cast<double>(parameters_);
}

}  // namespace spherical_actuator_calibration
