#pragma once

#include <array>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Joint axes and offsets at coordinates of a ParameterSpace, prepared for the orientations of many
/// samples. Corrections of readings and the orientation map act apart from them, on what the
/// sensors read.
class JointPoint {
 public:
  static constexpr int kCoordinates = static_cast<int>(ParameterSpace::kPerJoint) * kJoints;

  JointPoint(const ParameterSpace& space, const Eigen::VectorXd& x);

  /// R_stator_rotor at corrected readings `q` [rad]: the product of exponentials of paper (1).
  Eigen::Matrix3d orientation(const Eigen::Vector3d& q) const;

  /// The same, and ∂ξ/∂(offset, u, v of each joint), where R becomes e^{ξ̂}R (doc/method.md, Joint
  /// (8), (12–14)); without joints they are not coordinates, but those of freeRotorJoints().
  struct Linearized {
    Eigen::Matrix3d R_stator_rotor;
    Eigen::Matrix<double, 3, kCoordinates> d_coordinates;
  };
  Linearized linearized(const Eigen::Vector3d& q) const;

 private:
  /// One joint: what of e^{ω̂q} = ωωᵀ + cos q (1 − ωωᵀ) + sin q ω̂ does not depend on q.
  struct Joint {
    Eigen::Matrix3d along;                  ///< ωωᵀ
    Eigen::Matrix3d across;                 ///< 1 − ωωᵀ
    Eigen::Matrix3d crossed;                ///< ω̂
    Eigen::Vector3d axis;                   ///< ω, unit
    Eigen::Matrix<double, 3, 2> d_axis;     ///< ∂ω/∂(u, v)
    Eigen::Matrix<double, 3, 2> d_crossed;  ///< ω̂ ∂ω/∂(u, v)
    double offset = 0.0;                    ///< [rad]

    Eigen::Matrix3d turn(double sine, double cosine) const {
      return along + cosine * across + sine * crossed;
    }
  };

  std::array<Joint, kJoints> joints_;
};

}  // namespace sac
