#include "spherical_actuator_calibration/study/cramer_rao_bound.hpp"

#include <Eigen/LU>

#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

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
  problem.observations = selectObservations(model.space(), samples, request, options);
  problem.prior.x = truth;
  problem.prior.covariance = Eigen::MatrixXd::Zero(truth.size(), truth.size());
  const ObservationEvaluator evaluator(problem, options);
  const ChosenCoordinates chosen(truth.size(), free);
  InformationSum sum(chosen.size());
  const ModelPoint point = evaluator.at(truth);
  LinearizedObservation linear;
  WhitenedObservation whitened;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    evaluator.linearize(n, point, linear);
    whiten(linear, whiteningOf(evaluator.noise(n, linear)), chosen, whitened);
    sum.add(whitened);
  }
  return sum.information().inverse();
}

}  // namespace sac
