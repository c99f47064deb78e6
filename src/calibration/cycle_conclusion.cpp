#include "cycle_conclusion.hpp"

#include <algorithm>
#include <iterator>

#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/participation.hpp"
#include "spherical_actuator_calibration/estimation/workspace_uncertainty.hpp"

namespace sac {
namespace {

std::vector<ParameterEstimate> parameterEstimates(const ParameterSpace& space,
                                                  const std::vector<Eigen::Index>& requested,
                                                  const std::vector<Eigen::Index>& unobservable,
                                                  const ParameterBelief& before,
                                                  const ParameterBelief& after) {
  const Eigen::VectorXd nominal = space.reportedValues(Eigen::VectorXd::Zero(space.size()));
  const Eigen::VectorXd initial = space.reportedValues(before.x);
  const Eigen::VectorXd values = space.reportedValues(after.x);
  const Eigen::VectorXd stddevs = space.reportedStddevs(after.x, after.covariance);
  std::vector<ParameterEstimate> estimates;
  for (const Eigen::Index p : requested) {
    ParameterEstimate estimate;
    estimate.name = space.name(p);
    estimate.nominal = nominal[p];
    estimate.initial = initial[p];
    estimate.value = values[p];
    estimate.stddev = stddevs[p];
    estimate.unit = space.unit(p);
    estimate.observable = !std::binary_search(unobservable.begin(), unobservable.end(), p);
    estimates.push_back(estimate);
  }
  return estimates;
}

}  // namespace

void reportIteration(const Estimate& estimate, CycleReport& report) {
  report.iterations = static_cast<std::uint32_t>(estimate.iterations);
  report.error_history = estimate.error_history;
  report.reduced_chi_square = estimate.reduced_chi_square;
  report.degrees_of_freedom = estimate.degrees_of_freedom;
  report.condition_number = estimate.condition_number;
  report.solve_time = estimate.solve_time;
}

SampleResidual reportedResidual(const ObservationResidual& from, std::uint32_t id) {
  SampleResidual residual;
  residual.id = id;
  residual.quantity = from.observation.quantity;
  residual.residual = from.residual.norm();
  residual.standardized = from.standardized;
  residual.rejected = from.rejected;
  if (from.rejected) {
    residual.reason = format("misfit is %.1f times its uncertainty", from.standardized);
  }
  return residual;
}

void conclude(const CalibrationModel& model,
              const Estimate& estimate,
              const CycleCoordinates& coordinates,
              ExpectedErrors expected_errors,
              CalibrationState& state,
              CycleReport& report) {
  report.success = true;
  report.open_directions =
      nameOpenDirections(model.space(), estimate.open_directions, estimate.belief);
  const std::vector<Eigen::Index> in_directions = coordinatesOf(estimate.open_directions);
  std::vector<Eigen::Index> open;
  std::set_union(coordinates.unobservable.begin(),
                 coordinates.unobservable.end(),
                 in_directions.begin(),
                 in_directions.end(),
                 std::back_inserter(open));
  report.estimates =
      parameterEstimates(model.space(), coordinates.requested, open, state.belief, estimate.belief);
  state.belief = estimate.belief;
  for (const Eigen::Index p : coordinates.requested) {
    if (!std::binary_search(open.begin(), open.end(), p)) {
      state.identified[static_cast<std::size_t>(p)] = true;
    }
  }
  for (const Eigen::Index p : in_directions) {
    state.identified[static_cast<std::size_t>(p)] = false;
  }
  // Also those that an earlier cycle took for identified: it saw no other place.
  for (const Eigen::Index first : estimate.ambiguous) {
    state.identified[static_cast<std::size_t>(first)] = false;
    state.identified[static_cast<std::size_t>(first) + 1] = false;
  }
  if (expected_errors == ExpectedErrors::kReported) {
    const WorkspaceUncertainty uncertainty = workspaceUncertainty(model, state.belief);
    report.orientation_uncertainty = uncertainty.orientation;
    report.torque_uncertainty = uncertainty.torque;
  }
}

}  // namespace sac
