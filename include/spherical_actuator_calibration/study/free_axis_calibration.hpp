#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Level 1 in the form that the paper prints (section 3.1, equations (8–15)): twelve unknowns,
/// since the axes may lose their unit length. For comparison with the paper only; calibrations use
/// the joint cycle, whose axes stay on the sphere.
enum class JacobianUse {
  kEveryIteration,  ///< Gauss–Newton
  kOnce,            ///< of the nominal parameters, kept: the chord method
};

/// Joint with axes of any length.
struct FreeAxes {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< column k: ω_k, of any length > 0
  Eigen::Vector3d offsets = Eigen::Vector3d::Zero();   ///< [rad]
};

/// Rotor orientation e^{ω̂₁(q₁+δq₁)} e^{ω̂₂(q₂+δq₂)} e^{ω̂₃(q₃+δq₃)}, axes of any length.
Eigen::Matrix3d rotorOrientation(const FreeAxes& joints, const Eigen::Vector3d& q);

/// Parameters before the first and after each iteration, and ε₁ [rad] of each (paper (16)).
struct FreeAxisPath {
  std::vector<FreeAxes> joints;
  std::vector<double> errors;
};

/// Iterates from `start` by minimum-norm least squares over the samples with an orientation.
FreeAxisPath calibrateFreeAxes(const std::vector<Sample>& samples,
                               const FreeAxes& start,
                               JacobianUse use,
                               int iterations);

}  // namespace sac
