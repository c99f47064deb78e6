#include "spherical_actuator_calibration/assessment/sample_influence.hpp"

#include <optional>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "spherical_actuator_calibration/estimation/linearization.hpp"

namespace sac {
namespace {

using WhitenedJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// One used observation, divided by its noise.
struct Whitened {
  std::size_t observation = 0;
  WhitenedJacobian jacobian;  ///< in the estimated coordinates
  Eigen::Vector3d residual;
};

/// Coordinates that the cycle has estimated, at least in part.
std::vector<Eigen::Index> estimatedCoordinates(const ParameterSpace& space,
                                               const CycleReport& report) {
  std::set<std::string> names;
  for (const ParameterEstimate& estimate : report.estimates) {
    if (estimate.observable) {
      names.insert(estimate.name);
    }
  }
  for (const OpenDirection& open : report.open_directions) {
    for (Eigen::Index p = 0; p < space.size(); ++p) {
      if (open.direction[p] != 0.0) {
        names.insert(space.name(p));
      }
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

/// What held the open directions of the cycle: the prior, whose uncertainty along them is still
/// that of the belief after it.
Eigen::MatrixXd priorInformation(const std::vector<OpenDirection>& open,
                                 const ParameterBelief& after,
                                 const std::vector<Eigen::Index>& coordinates) {
  const auto size = static_cast<Eigen::Index>(coordinates.size());
  if (open.empty()) {
    return Eigen::MatrixXd::Zero(size, size);
  }
  Eigen::MatrixXd spanning(after.x.size(), static_cast<Eigen::Index>(open.size()));
  for (std::size_t k = 0; k < open.size(); ++k) {
    spanning.col(static_cast<Eigen::Index>(k)) = open[k].direction;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> factor(spanning);
  const Eigen::MatrixXd basis =
      factor.householderQ() * Eigen::MatrixXd::Identity(spanning.rows(), spanning.cols());
  const Eigen::MatrixXd covariance = basis.transpose() * after.covariance * basis;
  const Eigen::MatrixXd directions = basis(coordinates, Eigen::all);
  return directions * covariance.ldlt().solve(directions.transpose());
}

/// An observation as the fit without it sees it.
struct LeftOut {
  double leverage = 0.0;
  Eigen::Vector3d predicted_residual;  ///< (I − H)⁻¹ r, where other observations predict it
  std::optional<Eigen::Vector3d> sole_direction;  ///< that no other observation predicts
};

LeftOut leaveOut(const Eigen::Matrix3d& hat, const Eigen::Vector3d& residual) {
  // A standard deviation that would grow a thousandfold is no prediction.
  constexpr double kSmallestCheck = 1e-6;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (hat + hat.transpose()));
  LeftOut result;
  result.leverage = hat.trace() / 3.0;
  result.predicted_residual.setZero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = eigen.eigenvectors().col(k);
    const double check = 1.0 - eigen.eigenvalues()[k];
    if (check < kSmallestCheck) {
      result.sole_direction = direction;
    } else {
      result.predicted_residual += direction * (direction.dot(residual) / check);
    }
  }
  return result;
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
  information += priorInformation(report.open_directions, after.belief, coordinates);
  const Eigen::LDLT<Eigen::MatrixXd> factor(information);
  const Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::VectorXd stddevs = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();

  std::vector<SampleInfluence> influences;
  influences.reserve(used.size());
  for (const Whitened& item : used) {
    const Eigen::MatrixXd gain = covariance * item.jacobian.transpose();
    const LeftOut left_out = leaveOut(item.jacobian * gain, item.residual);
    const auto largest = [&stddevs](const Eigen::VectorXd& change, Eigen::Index& place) {
      return change.cwiseAbs().cwiseQuotient(stddevs).maxCoeff(&place);
    };
    SampleInfluence influence;
    influence.id = samples[problem.observations[item.observation].sample].id;
    influence.quantity = problem.observations[item.observation].quantity;
    influence.leverage = left_out.leverage;
    Eigen::Index worst = 0;
    influence.largest_shift = largest(gain * left_out.predicted_residual, worst);
    influence.irreplaceable = left_out.sole_direction.has_value();
    if (left_out.sole_direction) {
      largest(gain * *left_out.sole_direction, worst);
    }
    influence.parameter = model.space().name(coordinates[static_cast<std::size_t>(worst)]);
    influences.push_back(influence);
  }
  return influences;
}

}  // namespace sac
