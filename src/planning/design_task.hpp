#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "pose_candidates.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// A coil of a pattern by its place among the coils of a candidate, and the way of its current.
struct SignedTerm {
  std::size_t term = 0;
  int sign = 1;
};
using TermPattern = std::vector<SignedTerm>;

/// A candidate with the patterns to excite there.
struct DesignedPose {
  std::size_t candidate = 0;  ///< index into the candidates
  std::vector<TermPattern> patterns;
};

/// What designs are judged by, and what they may be like. F coordinates are to be estimated. Where
/// one pose alone is looked at, its kPoseErrors come behind them, each of unit variance before
/// anything is measured; elsewhere they are eliminated.
struct DesignTask {
  Eigen::MatrixXd known;  ///< information before the first pose, F×F, positive definite
  Eigen::SparseMatrix<double> reported;  ///< ∂(values for people)/∂(coordinates), F×F
  std::vector<std::size_t> visited;      ///< per coil: measuredVisits()
  std::size_t patterns_per_pose = 6;
  std::size_t coils_per_pattern = 4;
  double minimum_spacing = 0.1;  ///< rotation angle between two poses [rad]
};

/// ∂(values for people)/∂(coordinates) at x. Where a value has no derivative, as the angles of an
/// axis at polar = ±π/2, its coordinate stands for it.
Eigen::SparseMatrix<double> reportedDerivative(const ParameterSpace& space,
                                               const Eigen::VectorXd& x,
                                               const std::vector<Eigen::Index>& coordinates);

/// Variances of the values for people [rad²]. `covariance`: of the coordinates, with those of a
/// pose or without.
Eigen::VectorXd reportedVariances(const DesignTask& task, const Eigen::MatrixXd& covariance);

/// The torque of a pattern, in standard deviations of the torque sensor.
WhitenedObservation patternObservation(const PoseCandidate& candidate, const TermPattern& pattern);

/// Information of one pose and of what its errors are before, (F + kPoseErrors) square.
Eigen::MatrixXd poseInformation(const DesignTask& task,
                                const PoseCandidate& candidate,
                                const std::vector<TermPattern>& patterns);

/// Information of all poses and what is known before, F×F.
Eigen::MatrixXd designInformation(const DesignTask& task,
                                  const std::vector<PoseCandidate>& candidates,
                                  const std::vector<DesignedPose>& poses);

/// Covariance of the coordinates and the errors of pose `place`, in a design of these poses.
Eigen::MatrixXd covarianceAtPose(const DesignTask& task,
                                 const std::vector<PoseCandidate>& candidates,
                                 const std::vector<DesignedPose>& poses,
                                 std::size_t place);

/// The same at a pose where nothing is measured yet. `covariance`: F×F.
Eigen::MatrixXd covarianceAtNewPose(const Eigen::MatrixXd& covariance);

/// Norm of variances that stands for the largest one, of exponent p, and its weights: of sum 1, and
/// along its gradient.
double steepNorm(const Eigen::VectorXd& variances, double exponent);
Eigen::VectorXd steepWeights(const Eigen::VectorXd& variances, double exponent);

/// Of an information matrix.
Eigen::MatrixXd covarianceOf(const Eigen::MatrixXd& information);

}  // namespace sac
