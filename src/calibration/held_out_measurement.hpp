#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// A measurement that is held out, with what the test needs of it.
struct HeldOutMeasurement {
  Quantity quantity = Quantity::kOrientation;
  std::size_t sample = 0;          ///< its place among all samples
  bool counts = false;             ///< in the test
  std::vector<std::size_t> coils;  ///< that are on, of a torque
  std::size_t dwell = 0;           ///< that shares its errors
  double squared_norm = 0.0;       ///< of its residual
  WhitenedObservation misfit;      ///< empty where it does not count, as what follows
  SharedLoading loading = SharedLoading::Zero();
  Whitening whitening;
};

/// Those that a sample has current in.
inline std::vector<std::size_t> coilsOn(const Sample& sample, double current_threshold) {
  std::vector<std::size_t> coils;
  for (const Excitation& one : excitedCoils(sample, current_threshold)) {
    coils.push_back(one.coil);
  }
  return coils;
}

}  // namespace sac
