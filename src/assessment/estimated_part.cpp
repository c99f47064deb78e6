#include "estimated_part.hpp"

#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include <Eigen/QR>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

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

std::vector<std::size_t> keptObservations(const EstimationProblem& problem,
                                          const CycleReport& report) {
  std::set<std::pair<std::uint32_t, Quantity>> rejected;
  for (const SampleResidual& residual : report.residuals) {
    if (residual.rejected) {
      rejected.emplace(residual.id, residual.quantity);
    }
  }
  std::vector<std::size_t> kept;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    const Observation& what = problem.observations[n];
    if (rejected.count({(*problem.samples)[what.sample].id, what.quantity}) == 0) {
      kept.push_back(n);
    }
  }
  return kept;
}

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
  return directions * solveSemidefinite(covariance, directions.transpose());
}

}  // namespace sac
