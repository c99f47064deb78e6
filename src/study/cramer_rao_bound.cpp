#include "spherical_actuator_calibration/study/cramer_rao_bound.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "spherical_actuator_calibration/estimation/linearization.hpp"

namespace sac {

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
  Eigen::MatrixXd J(3, count);
  LinearizedObservation linear;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    evaluator.linearize(n, truth, linear);
    for (Eigen::Index k = 0; k < count; ++k) {
      J.col(k) = linear.jacobian.col(free[static_cast<std::size_t>(k)]);
    }
    information += J.transpose() * evaluator.noise(n, linear).llt().solve(J);
  }
  return information.inverse();
}

}  // namespace sac
