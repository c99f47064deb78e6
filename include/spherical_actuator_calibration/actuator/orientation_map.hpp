#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

/// A Gaussian process over the joint readings for the rotation that axes, offsets and reading
/// corrections leave unexplained (doc/method.md, Residual map). Components of the rotation vector
/// are independent, in the stator frame.
struct OrientationMapDescription {
  /// Length scale of each joint, of the chord 2 sin(Δq/2) between two readings [rad].
  std::array<double, 3> length = {1.0, 1.0, 1.0};
  std::array<double, 3> amplitude = {};  ///< standard deviation of each component [rad]
  std::array<double, 3> noise = {};      ///< of a measured pose, beside the smooth part [rad]
  /// What of the noise is the tracker's, as stated, of each component [rad]. 0: not known.
  double tracker_noise = 0.0;
  std::vector<Eigen::Vector3d> readings;   ///< raw sensor angles of the support points [rad]
  std::vector<Eigen::Vector3d> rotations;  ///< unexplained rotation vectors there [rad]
};

/// Throws ConfigError that names the field: sizes that differ, no support points or more than
/// kMostMapPoints, numbers that are not finite, lengths, amplitudes or noises that are not
/// positive, a negative noise of the tracker.
void validate(const OrientationMapDescription& description);

/// Support points that a map may have: one evaluation costs an exponential for each.
inline constexpr std::size_t kMostMapPoints = 400;

/// The process given its support points.
class OrientationMap {
 public:
  /// Throws ConfigError as validate().
  explicit OrientationMap(OrientationMapDescription description);

  const OrientationMapDescription& description() const { return description_; }

  /// Rotation vector at a raw reading, stator frame [rad]: R = e^{mean} R(q). Goes to zero away
  /// from the support points, where the axes alone are left.
  Eigen::Vector3d mean(const Eigen::Vector3d& reading) const;

  struct Uncertainty {
    Eigen::Vector3d variance;  ///< of the smooth part [rad²]
    Eigen::Vector3d noise;     ///< of what is not smooth: measured poses differ by it, too [rad²]
    Eigen::Vector3d of_rotor;  ///< both, the tracker's noise left out: of where the rotor is [rad²]
    /// Share of the variance that the support points explain, 0…1: where it is small, the axes
    /// alone tell the orientation.
    double support = 0.0;
  };
  Uncertainty uncertainty(const Eigen::Vector3d& reading) const;

 private:
  Eigen::VectorXd kernel(const Eigen::Vector3d& reading) const;

  OrientationMapDescription description_;
  Eigen::Matrix3Xd readings_;       ///< of the support points, as columns
  Eigen::MatrixX3d weights_;        ///< of the kernel, a column per component
  std::array<Cholesky, 3> factor_;  ///< of K + (noise/amplitude)² I
};

/// exp(−½ Σ (2 sin(Δq_k/2) / length_k)²) of two readings: periodic in each joint.
double mapKernel(const std::array<double, 3>& length,
                 const Eigen::Vector3d& a,
                 const Eigen::Vector3d& b);

/// Below this share of explained variance a map counts as having no support.
inline constexpr double kLeastMapSupport = 0.3;

}  // namespace sac
