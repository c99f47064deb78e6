#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// What the residuals tell of quantities that the model lacks, by one step from the estimate. What
/// the parameters could take up of them is not counted as told.
class ResidualProbe {
 public:
  /// `estimated`: coordinates that were, ascending; `quantities`: how many the model lacks.
  ResidualProbe(std::vector<Eigen::Index> estimated, Eigen::Index quantities);

  /// Residuals in units of their noise, their derivatives by all coordinates and by the quantities.
  void add(const Eigen::MatrixXd& by_coordinates,
           const Eigen::MatrixXd& by_quantities,
           const Eigen::VectorXd& residual);

  struct Finding {
    bool is_told = false;  ///< beside what the parameters explain as well
    Eigen::VectorXd value;
    Eigen::MatrixXd covariance;
    /// By how much the coordinates estimated without the quantities are off for them.
    Eigen::VectorXd bias;
  };
  /// Of `count` quantities from `first` on together, where there are none of the others.
  Finding find(Eigen::Index first, Eigen::Index count) const;

 private:
  std::vector<Eigen::Index> estimated_;
  InformationSum sum_;  ///< by what was estimated, then by the quantities
};

}  // namespace sac
