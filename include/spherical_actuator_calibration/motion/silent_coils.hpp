#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// Coils that carried no current: what was read of them is hardly more than the noise of the
/// reading. Such readings would tell of an axis though nothing flowed: noise that counts as current
/// turns the axis to where it makes no torque. (doc/motion.md, Silent coils)
class SilentCoils {
 public:
  /// More currents, of the same coils.
  void add(const MotionStreams& streams);
  /// By their index, ascending. None where all are alike.
  std::vector<std::size_t> found() const;

 private:
  // Sums over the readings of each coil [A²].
  Eigen::ArrayXd squares_;
  Eigen::ArrayXd third_;  ///< of third differences
  double readings_ = 0.0;
  double differences_ = 0.0;
};

/// Those of a recording.
std::vector<std::size_t> silentCoils(const MotionRecording& recording);

/// Coordinates that only these coils tell of: their axes, and their strengths where they are
/// modelled. Ascending.
std::vector<Eigen::Index> coordinatesOfCoils(const ParameterSpace& space,
                                             const std::vector<std::size_t>& coils);

}  // namespace sac
