#include "spherical_actuator_calibration/core/sample_influence.hpp"

#include <cmath>
#include <set>

#include <Eigen/Cholesky>

#include "spherical_actuator_calibration/core/linearization.hpp"

namespace spherical_actuator_calibration {
namespace {

using WhitenedJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// One used observation, divided by its noise.
struct Whitened {
  std::size_t observation = 0;
  WhitenedJacobian jacobian;  ///< in the estimated coordinates
  Eigen::Vector3d residual;
};

/// Coordinates that the cycle has estimated.
std::vector<Eigen::Index> estimatedCoordinates(const ParameterSpace& space,
                                               const CycleReport& report) {
  std::set<std::string> names;
  for (const ParameterEstimate& estimate : report.estimates) {
    if (estimate.observable) {
      names.insert(estimate.name);
    }
  }
  std::vector<Eigen::Index> coordinates;
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    if (names.count(space.name(p)) > 0) {
      coordinates.push_back(p);
    }
  }
  return coordinates;
}

std::vector<Whitened> whitenedObservations(const EstimationProblem& problem,
                                           const CycleReport& report,
                                           const std::vector<Eigen::Index>& coordinates,
                                           const Eigen::VectorXd& x,
                                           const EstimationOptions& options) {
  std::set<std::pair<std::uint32_t, Quantity>> rejected;
  for (const SampleResidual& residual : report.residuals) {
    if (residual.rejected) {
      rejected.emplace(residual.id, residual.quantity);
    }
  }
  const ObservationEvaluator evaluator(problem, options);
  std::vector<bool> held(static_cast<std::size_t>(problem.model->space().size()), true);
  for (const Eigen::Index p : coordinates) {
    held[static_cast<std::size_t>(p)] = false;
  }
  std::vector<Whitened> used;
  LinearizedObservation linear;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    const Observation& what = problem.observations[n];
    if (rejected.count({(*problem.samples)[what.sample].id, what.quantity}) > 0) {
      continue;
    }
    evaluator.linearize(n, x, linear);
    const Eigen::LLT<Eigen::Matrix3d> noise(evaluator.covariance(n, linear, held));
    Whitened item;
    item.observation = n;
    item.residual = noise.matrixL().solve(linear.residual);
    item.jacobian.resize(3, static_cast<Eigen::Index>(coordinates.size()));
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      item.jacobian.col(static_cast<Eigen::Index>(k)) =
          noise.matrixL().solve(linear.jacobian.col(coordinates[k]));
    }
    used.push_back(std::move(item));
  }
  return used;
}

}  // namespace

std::vector<SampleInfluence> sampleInfluences(const CalibrationModel& model,
                                              const std::vector<Sample>& samples,
                                              const CycleReport& report,
                                              const CalibrationState& after,
                                              const EstimationOptions& options) {
  const std::vector<Eigen::Index> coordinates = estimatedCoordinates(model.space(), report);
  if (!report.success || coordinates.empty()) {
    return {};
  }
  EstimationProblem problem;
  problem.model = &model;
  problem.samples = &samples;
  problem.observations = selectObservations(samples, {report.cycle, report.coil}, options);
  problem.prior = after.belief;
  const std::vector<Whitened> used =
      whitenedObservations(problem, report, coordinates, after.belief.x, options);

  const auto count = static_cast<Eigen::Index>(coordinates.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  for (const Whitened& item : used) {
    information += item.jacobian.transpose() * item.jacobian;
  }
  const Eigen::LDLT<Eigen::MatrixXd> factor(information);
  const Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::VectorXd stddevs = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();

  std::vector<SampleInfluence> influences;
  influences.reserve(used.size());
  for (const Whitened& item : used) {
    const Eigen::MatrixXd gain = covariance * item.jacobian.transpose();
    const Eigen::Matrix3d hat = item.jacobian * gain;
    const Eigen::Matrix3d checked = Eigen::Matrix3d::Identity() - hat;
    const Eigen::VectorXd shift = gain * checked.ldlt().solve(item.residual);
    SampleInfluence influence;
    influence.id = samples[problem.observations[item.observation].sample].id;
    influence.quantity = problem.observations[item.observation].quantity;
    influence.leverage = hat.trace() / 3.0;
    Eigen::Index worst = 0;
    influence.largest_shift = shift.cwiseAbs().cwiseQuotient(stddevs).maxCoeff(&worst);
    influence.parameter = model.space().name(coordinates[static_cast<std::size_t>(worst)]);
    influences.push_back(influence);
  }
  return influences;
}

}  // namespace spherical_actuator_calibration
