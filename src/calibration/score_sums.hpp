#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "effect_candidates.hpp"
#include "further_columns.hpp"
#include "score_sum.hpp"
#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// What the observations that an estimate kept say at its solution.
struct ScoreSums {
  /// Of a later part of the session, in the columns that may step.
  struct Later {
    std::uint32_t after = 0;      ///< id of the last sample before it
    Eigen::MatrixXd crossed;      ///< with the coordinates, P×k
    Eigen::MatrixXd information;  ///< k×k, of columns of one step; zero beyond
    Eigen::VectorXd gradient;     ///< k
  };

  ScoreSum all;
  /// One for each time at which something may have changed, the last one first.
  std::vector<Later> later;
};

/// Sums up, in the order of the samples' stamps.
ScoreSums scoreSums(const EstimationProblem& problem,
                    const Estimate& estimate,
                    const EstimationOptions& options,
                    const FurtherColumns& columns,
                    const std::vector<EffectCandidate>& effects,
                    const std::vector<StepCandidate>& steps);

}  // namespace sac
