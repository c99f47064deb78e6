#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"

namespace sac {

/// Covariance at the Cramér–Rao bound of the coordinates `free`: inverse of Σ JᵀJ/σ² at the truth,
/// the other coordinates known, with the stated noise of the samples that serve the cycle, joint
/// sensors included. No unbiased estimate has a smaller one. Not finite where the samples leave a
/// direction open.
Eigen::MatrixXd cramerRaoBound(const CalibrationModel& model,
                               const std::vector<Sample>& samples,
                               const CycleRequest& request,
                               const std::vector<Eigen::Index>& free,
                               const Eigen::VectorXd& truth);

}  // namespace sac
