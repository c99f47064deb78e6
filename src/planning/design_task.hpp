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

/// What designs are judged by, and what they may be like. F coordinates are to be estimated.
struct DesignTask {
  Eigen::MatrixXd known;  ///< information before the first pose, F×F, positive definite
  Eigen::SparseMatrix<double> reported;  ///< ∂(values for people)/∂(coordinates), F×F
  Eigen::Vector3d joint_variance = Eigen::Vector3d::Zero();  ///< of the joints' readings [rad²]
  std::size_t patterns_per_pose = 6;
  std::size_t coils_per_pattern = 4;
  double minimum_spacing = 0.1;  ///< rotation angle between two poses [rad]
};

/// ∂(values for people)/∂(coordinates) at x. A value that has no derivative there, as the azimuth
/// of an axis at polar = ±π/2, has a row of zeros.
Eigen::SparseMatrix<double> reportedDerivative(const ParameterSpace& space,
                                               const Eigen::VectorXd& x,
                                               const std::vector<Eigen::Index>& coordinates);

/// Variances of the values for people [rad²].
Eigen::VectorXd reportedVariances(const DesignTask& task, const Eigen::MatrixXd& covariance);

/// The torque of a pattern, in units of its noise: of the torque sensor, and of the joints'
/// readings by what they change of the torque.
WhitenedObservation patternObservation(const DesignTask& task,
                                       const PoseCandidate& candidate,
                                       const TermPattern& pattern);

/// Information of all poses and what is known before, F×F.
Eigen::MatrixXd designInformation(const DesignTask& task,
                                  const std::vector<PoseCandidate>& candidates,
                                  const std::vector<DesignedPose>& poses);

/// Norm of variances that stands for the largest one, of exponent p, and its weights: of sum 1, and
/// along its gradient.
double steepNorm(const Eigen::VectorXd& variances, double exponent);
Eigen::VectorXd steepWeights(const Eigen::VectorXd& variances, double exponent);

/// Of an information matrix.
Eigen::MatrixXd covarianceOf(const Eigen::MatrixXd& information);

}  // namespace sac
