#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "spherical_actuator_calibration/motion/motion_problem.hpp"

namespace sac {

/// A motion as if it were not known through which coil the current of each channel flows: momentum
/// balance of some 40 windows at the nominal axes, each value in units of its usual size. What
/// inertia, loads and friction may explain is taken off: where little is known of inertia, hardly
/// any momentum is left, and the signs of all channels at once are not told.
struct ChannelImpulses {
  std::size_t coils = 0;
  Eigen::VectorXd momentum;  ///< for currents to explain; N values, none: windows are too few
  /// N × coils², column channel · coils + coil: what the current of a channel explains if it flows
  /// through that coil.
  Eigen::MatrixXd through;

  auto at(std::size_t channel, std::size_t coil) const {
    return through.col(static_cast<Eigen::Index>(channel * coils + coil));
  }
};

/// `current_delay`: by how much the stamps of the currents are later than those of the joints [s].
/// Precondition: the model has a torque model.
ChannelImpulses channelImpulses(const MotionProblem& problem, double current_delay);

}  // namespace sac
