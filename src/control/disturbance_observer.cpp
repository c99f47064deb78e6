#include "spherical_actuator_calibration/control/disturbance_observer.hpp"

#include <cmath>

namespace sac {

ValueRange disturbanceBandwidthRange() {
  constexpr double kLargest = 30.0;
  return ValueRange::closed(0.0, kLargest, "rad/s");
}

void validate(const DisturbanceObserverOptions& options) {
  requireInRange("disturbance bandwidth", options.bandwidth, disturbanceBandwidthRange());
  requireInRange("largest disturbance torque", options.largest_torque, ValueRange::positive("N m"));
}

DisturbanceObserver::DisturbanceObserver(const DisturbanceObserverOptions& options,
                                         double velocity_cutoff)
    : options_(options), velocity_cutoff_(velocity_cutoff) {
  validate(options);
}

void DisturbanceObserver::reset() {
  before_.reset();
  torque_.setZero();
}

void DisturbanceObserver::update(double step,
                                 const RigidRotor& rotor,
                                 const RotorState& state,
                                 const Eigen::Vector3d& coil_torque,
                                 Learning learning) {
  const Eigen::Vector3d& w = state.angular_velocity;
  if (!before_) {
    before_ = Before{w, coil_torque};
    return;
  }
  before_->coil_torque +=
      -std::expm1(-step * velocity_cutoff_) * (coil_torque - before_->coil_torque);
  const Eigen::Vector3d acceleration = (w - before_->angular_velocity) / step;
  before_->angular_velocity = w;
  const Eigen::Vector3d unexplained = rotor.inertia * acceleration + w.cross(rotor.inertia * w) -
                                      before_->coil_torque -
                                      gravityTorque(rotor, state.R_stator_rotor);
  Eigen::Vector3d found =
      torque_ - std::expm1(-step * options_.bandwidth) * (unexplained - torque_);
  if (found.norm() > options_.largest_torque) {
    found *= options_.largest_torque / found.norm();
  }
  if (learning == Learning::kFree ||
      (learning == Learning::kNoGrowth && found.norm() < torque_.norm())) {
    torque_ = found;
  }
}

}  // namespace sac
