#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/motion/channel_impulses.hpp"

namespace sac {

/// Through which coil the current of each channel flows.
struct CoilOrder {
  std::vector<std::size_t> coil;  ///< of each channel, all of them once
  std::vector<int> sign;          ///< of each channel; 0: through none
  double left = 0.0;              ///< squared misfit, of what the currents explain one by one

  /// By how many coils most channels are shifted.
  std::size_t steps() const;
  /// Channels beside the place of most, and one where most are shifted; channels that are turned or
  /// dead.
  std::size_t mistakes() const;
};

/// The order that explains a motion best, from the one described by exchanges of two, turns and
/// deaths of single coils, as long as each helps; also from all channels shifted by some.
CoilOrder bestCoilOrder(const ChannelImpulses& impulses);

/// What the order as it is described leaves.
double leftAsDescribed(const ChannelImpulses& impulses);

}  // namespace sac
