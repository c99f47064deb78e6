#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "design_task.hpp"

namespace sac {

/// G = C Rᵀ W R C: adding information A shrinks the weighted sum of variances by tr(G A), to first
/// order and at most. C: covariance, R: the task's `reported`, W: weights.
Eigen::MatrixXd sensitivityOf(const DesignTask& task,
                              const Eigen::MatrixXd& covariance,
                              const Eigen::VectorXd& weights);

/// A maximum over patterns.
struct PatternMaximum {
  double value = 0.0;
  TermPattern pattern;  ///< that has it; empty where the value is a bound only
};

/// Largest Σ_ij s_i s_j Q_ij over the coils' terms, each s within ±1, the sum of all |s| at most
/// `most`: it is reached by as many coils with s = ±1. Q (positive semidefinite) may have one more
/// row for a term that always counts. By branch and bound: a maximum not above `enough` comes out
/// as `enough`, and where it takes too many branches, a bound from above comes out.
PatternMaximum largestForm(const Eigen::MatrixXd& Q,
                           std::size_t coils,
                           std::size_t most,
                           double enough);

/// A maximum over visits to one pose.
struct VisitMaximum {
  double value = 0.0;
  /// That come near to it, task.patterns_per_pose; none where the value is a bound only.
  std::vector<TermPattern> patterns;
};

/// tr(G A) at most, for the information A of one visit: of the orientation, and of
/// task.patterns_per_pose torques of any patterns. Not above `enough`, it comes out as `enough`.
///
/// The errors u of the pose's readings are eliminated: A = min over L of Σ (J − D L)ᵀ(J − D L) +
/// LᵀL, D the derivatives by u. So any L gives a bound, which is a sum over the patterns again.
/// Here L is that of the patterns found so far, a few times over, from `elimination` on (empty:
/// none), which comes out as the best one.
VisitMaximum visitSensitivity(const DesignTask& task,
                              const PoseCandidate& candidate,
                              const Eigen::MatrixXd& sensitivity,
                              double enough,
                              Eigen::MatrixXd& elimination);

}  // namespace sac
