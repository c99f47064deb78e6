#pragma once

#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// Throws DataError on inconsistent input: an index out of range, a torque without a torque model.
inline void checkProblem(const EstimationProblem& problem) {
  const ParameterSpace& space = problem.model->space();
  const Eigen::Index size = space.size();
  if (problem.prior.x.size() != size || problem.prior.covariance.rows() != size ||
      problem.prior.covariance.cols() != size) {
    throw DataError("The prior does not have one entry for each of the " + std::to_string(size) +
                    " parameters.");
  }
  for (const Eigen::Index parameter : problem.free) {
    if (parameter < 0 || parameter >= size) {
      throw DataError("Parameter " + std::to_string(parameter) + " does not exist.");
    }
  }
  for (const Observation& observation : problem.observations) {
    if (observation.sample >= problem.samples->size()) {
      throw DataError("Sample " + std::to_string(observation.sample) + " does not exist.");
    }
    if (observation.quantity == Quantity::kTorque && !problem.model->hasTorqueModel()) {
      throw DataError(
          "Torque samples need poles, coils and a torque curve in the actuator description.");
    }
    validate((*problem.samples)[observation.sample], space.coils());
  }
}

}  // namespace sac
