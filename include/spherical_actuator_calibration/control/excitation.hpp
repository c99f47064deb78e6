#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/usual_currents.hpp"

namespace sac {

/// What currents must never exceed.
struct CurrentBounds {
  double coil = kUsualCoilCurrent;      ///< of each coil [A]
  double total = kUsualTotalCurrent;    ///< Σ|I| [A]
  double square = kUsualSquareCurrent;  ///< ΣI² [A²]
};

/// The part of `currents` that makes no torque by the model: I − Qᵀ(QQᵀ)⁻¹QI, with Q the torque per
/// ampere (3×l, torquePerAmpere()). Zero where Q has not full rank.
Eigen::VectorXd withoutTorque(const Eigen::Matrix3Xd& torque_per_ampere,
                              const Eigen::VectorXd& currents);

/// The largest share, 0 to 1, of `excitation` that can be added to `control` within the bounds; 0
/// where `control` alone is not within them.
double excitationShare(const Eigen::VectorXd& control,
                       const Eigen::VectorXd& excitation,
                       const CurrentBounds& bounds);

/// The largest share, 0 to 1, of `currents` that is within the bounds on sums, Σ|I| and ΣI².
double shareWithinSums(const Eigen::VectorXd& currents, const CurrentBounds& bounds);

}  // namespace sac
