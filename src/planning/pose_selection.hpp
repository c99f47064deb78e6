#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "pose_candidates.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"

namespace sac {

/// A candidate that was chosen, with the torques to measure there.
struct SelectedPose {
  std::size_t candidate = 0;         ///< index into the candidates
  std::vector<std::size_t> torques;  ///< indices into its coils, ascending
};

/// Chooses candidates by the information matrix N of the coordinates to estimate (F×F).
class PoseSelection {
 public:
  struct Options {
    std::size_t torques_per_pose = 6;
    double minimum_spacing = 0.1;  ///< rotation angle between two poses [rad]
    PlanCriterion criterion = PlanCriterion::kWorstStddev;  ///< of exchanges
  };

  /// Keeps a reference to the candidates. `information`: what is known before, positive definite.
  PoseSelection(const std::vector<PoseCandidate>& candidates,
                Eigen::MatrixXd information,
                const Options& options);

  /// Adds the candidate that increases det N most. Returns false when none is left.
  bool add();

  /// Exchanges each pose once, if another one, or other torques at the same one, serve the
  /// criterion better. Returns whether any was exchanged.
  bool exchange();

  const std::vector<SelectedPose>& poses() const { return poses_; }

  /// Largest standard deviation of the coordinates [rad].
  double worstStddev() const;

 private:
  /// A candidate with its best torques, and how good it is: more is better.
  struct Choice {
    SelectedPose pose;
    double merit = 0.0;
  };

  bool keepsDistance(std::size_t candidate) const;
  Choice evaluate(std::size_t candidate,
                  const Eigen::MatrixXd& covariance,
                  PlanCriterion criterion) const;
  /// The best of the candidates that may join the poses; of merit −∞ when there is none.
  Choice best(const Eigen::MatrixXd& covariance, PlanCriterion criterion) const;
  /// What is known before and from the poses.
  Eigen::MatrixXd covariance() const;

  const std::vector<PoseCandidate>& candidates_;
  Eigen::MatrixXd known_;
  Options options_;
  std::vector<SelectedPose> poses_;
};

}  // namespace sac
