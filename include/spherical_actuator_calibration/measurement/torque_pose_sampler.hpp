#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"

namespace sac {

/// How much a coil tells at a pose.
enum class PoseGrade {
  kBlind,      ///< no wanted pole where the curve is steep and certain
  kUncertain,  ///< a wanted pole there, but another pole where the curve is uncertain
  kClear,      ///< a wanted pole there, every other pole where the curve is certain
};

/// Pose with joints 1 and 2 uniform within ± tilt, joint 3 within ±π [rad].
Eigen::Vector3d randomPose(double tilt, NoiseSource& noise);

/// Draws poses at which a coil's torque says much about the axes (nominal geometry).
class TorquePoseSampler {
 public:
  /// `actuator` must have a torque model. `tilt`: largest |q₁| and |q₂| drawn [rad].
  TorquePoseSampler(const Actuator& actuator, double tilt);

  /// The first clear pose among a bounded number drawn, else the best of them. `coil` and `pole`
  /// count from 0; without a pole, any serves.
  Eigen::Vector3d draw(std::size_t coil, std::optional<std::size_t> pole, NoiseSource& noise) const;

  PoseGrade grade(const Eigen::Vector3d& joint_position,
                  std::size_t coil,
                  std::optional<std::size_t> pole) const;

 private:
  bool isInformative(double psi) const;
  bool isUncertain(double psi) const;

  TorqueCurve curve_;
  TorqueGeometry geometry_;
  JointGeometry joints_;
  double tilt_;
};

}  // namespace sac
