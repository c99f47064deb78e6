#include "spherical_actuator_calibration/control/excitation.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"

namespace sac {
namespace {

bool isWithin(const Eigen::VectorXd& currents, const CurrentBounds& bounds) {
  return currents.cwiseAbs().maxCoeff() <= bounds.coil &&
         currents.cwiseAbs().sum() <= bounds.total && currents.squaredNorm() <= bounds.square;
}

}  // namespace

Eigen::VectorXd withoutTorque(const Eigen::Matrix3Xd& torque_per_ampere,
                              const Eigen::VectorXd& currents) {
  constexpr double kLeastRatio = 1e-9;  // of the eigenvalues of QQᵀ
  const Eigen::Matrix3d square = torque_per_ampere * torque_per_ampere.transpose();
  const Eigen::Vector3d values = symmetricEigenvalues(square);
  if (!(values[0] > kLeastRatio * values[2])) {
    return Eigen::VectorXd::Zero(currents.size());
  }
  const Eigen::Vector3d torque = torque_per_ampere * currents;
  return currents - torque_per_ampere.transpose() * Cholesky3(square).solve(torque);
}

// The bounds hold on a convex set of currents, so that all shares below a good one are good.
double excitationShare(const Eigen::VectorXd& control,
                       const Eigen::VectorXd& excitation,
                       const CurrentBounds& bounds) {
  constexpr int kBisections = 20;
  if (isWithin(control + excitation, bounds)) {
    return 1.0;
  }
  double good = 0.0;
  double bad = 1.0;
  for (int n = 0; n < kBisections; ++n) {
    const double middle = 0.5 * (good + bad);
    (isWithin(control + middle * excitation, bounds) ? good : bad) = middle;
  }
  return good;
}

double shareWithinSums(const Eigen::VectorXd& currents, const CurrentBounds& bounds) {
  const double total = currents.cwiseAbs().sum();
  const double square = currents.squaredNorm();
  double share = 1.0;
  if (total > bounds.total) {
    share = bounds.total / total;
  }
  if (square > bounds.square) {
    share = std::min(share, std::sqrt(bounds.square / square));
  }
  return share;
}

}  // namespace sac
