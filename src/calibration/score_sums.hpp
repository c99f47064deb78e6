#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// Columns beside the coordinates of a problem that residuals may depend on. All columns together:
/// the P coordinates, then the effects that the problem does not model, then the scales of the
/// joints' readings.
class FurtherColumns {
 public:
  explicit FurtherColumns(const EstimationProblem& problem);

  const ParameterSpace& space() const { return own_; }
  /// Of the effects that the problem does not model; its geometry is that of space().
  const CalibrationModel& model() const { return model_; }

  Eigen::Index effect(Eigen::Index coordinate) const { return own_.size() + coordinate; }
  Eigen::Index scale(std::size_t joint) const {
    return effect(model_.space().effects().size()) + static_cast<Eigen::Index>(joint);
  }
  Eigen::Index size() const { return scale(own_.joints()); }
  /// The first column of an effect, be it modelled or not, or −1 where there is none.
  Eigen::Index first(const std::string& effect) const;

 private:
  const ParameterSpace& own_;
  CalibrationModel model_;
};

/// What the observations that an estimate kept say of all columns at its solution.
struct ScoreSums {
  /// Of a later part of the session, in the columns of `stepped`.
  struct Later {
    std::uint32_t after = 0;      ///< id of the last sample before it
    Eigen::MatrixXd crossed;      ///< with the coordinates, k×P
    Eigen::MatrixXd information;  ///< k×k
    Eigen::VectorXd gradient;     ///< k
  };

  Eigen::MatrixXd information;  ///< Σ BᵀS⁻¹B, of all columns
  Eigen::VectorXd gradient;     ///< Σ BᵀS⁻¹r
  std::vector<Eigen::Index> stepped;
  std::vector<Later> later;  ///< one for each time at which something may have changed
};

/// Sums up, in the order of the samples' stamps. `stepped`: columns that may change during it.
ScoreSums scoreSums(const EstimationProblem& problem,
                    const Estimate& estimate,
                    const EstimationOptions& options,
                    const FurtherColumns& columns,
                    std::vector<Eigen::Index> stepped);

}  // namespace sac
