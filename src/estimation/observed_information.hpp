#pragma once

#include <cstddef>
#include <map>

#include <Eigen/Core>

#include "solution.hpp"

namespace sac {

/// What the active observations tell at a solution of the F estimated of P coordinates. J is
/// linearised there; S is the covariance that weighs an observation, R that of its sensors alone.
struct ObservedInformation {
  Eigen::MatrixXd data;  ///< F×F: Σ JᵀS⁻¹J
  /// F×F: Σ JᵀS⁻¹RS⁻¹J; not filled where that is `data`.
  Eigen::MatrixXd noise;
  Eigen::MatrixXd others;  ///< F×P: Σ JᵀS⁻¹J_held, zero columns for the estimated coordinates
  bool is_noise_alone = true;  ///< no uncertain held coordinate acts: S is R everywhere
  /// 3×F: R V⁻¹J of observations of dwells, V the covariance of all of the dwell; not held where
  /// that is J.
  std::map<std::size_t, Eigen::MatrixXd> weighed;
};

ObservedInformation observedInformation(const Solution& solution);

}  // namespace sac
