#pragma once

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// What a rotor can do between two measurements of its orientation.
struct JumpLimits {
  double largest_rate = 20.0;  ///< [rad/s]
  double tolerance = 0.02;     ///< of noise, whatever the time between two measurements [rad]
  int confirmations = 5;       ///< a new place is believed at its so manieth measurement in a row
};

/// Tells orientations that the rotor cannot have come to from those that it can, such as a tracker
/// that takes one marker for another. When the measurements stay at the new place, that is
/// believed.
class OrientationJumpFilter {
 public:
  explicit OrientationJumpFilter(const JumpLimits& limits) : limits_(limits) {}

  /// True when the orientation is plausible. `q_stator_rotor` must be a unit quaternion, and
  /// `stamp` newer than the one before.
  bool judge(Stamp stamp, const Eigen::Quaterniond& q_stator_rotor);

  /// The next orientation may be any.
  void restart();

 private:
  struct Place {
    Stamp stamp = 0;
    Eigen::Quaterniond q_stator_rotor = Eigen::Quaterniond::Identity();
  };

  bool follows(const Place& place, const Place& before) const;

  JumpLimits limits_;
  bool known_ = false;
  Place last_;        ///< newest plausible one, when known
  Place suspect_;     ///< newest one elsewhere
  int suspects_ = 0;  ///< measurements in a row that led to it
};

}  // namespace sac
