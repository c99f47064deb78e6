#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/linearization.hpp"

namespace sac {

/// Which observations and coordinates a sum over observations covers.
struct NormalEquationsInput {
  const ObservationEvaluator* evaluator = nullptr;
  const std::vector<Eigen::Matrix3d>* whitening = nullptr;  ///< W per observation, S⁻¹ = WᵀW
  std::vector<bool> active;                                 ///< per observation
};

/// Sums over the active observations at one point, for F chosen coordinates out of P.
struct NormalEquations {
  Eigen::MatrixXd information;  ///< F×F: Σ JᵀS⁻¹J
  Eigen::MatrixXd noise;        ///< F×F: Σ JᵀS⁻¹RS⁻¹J, R the sensor noise alone
  Eigen::MatrixXd others;  ///< F×P: Σ JᵀS⁻¹J_others, zero columns for the chosen coordinates
};

NormalEquations accumulateNormalEquations(const NormalEquationsInput& input,
                                          const Eigen::VectorXd& x,
                                          const std::vector<Eigen::Index>& coordinates);

}  // namespace sac
