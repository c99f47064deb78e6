#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "spherical_actuator_calibration/calibration/motion_follower.hpp"

namespace sac {

/// Tells on the topic motion_progress what a motion has told so far. Nothing of it is calibrated:
/// that is the cycle motion. Not thread-safe.
class MotionWatch {
 public:
  /// `wanted_stddev`: of each parameter of joints, poles and coils [rad].
  MotionWatch(ros::NodeHandle node,
              const Actuator& nominal,
              const CalibrationConfig& config,
              double wanted_stddev);

  /// One more window; none of an actuator whose motions tell nothing.
  void add(MotionSlice window);
  /// The motion until now. `wanted_stddev`: of the next one [rad]; nothing: as constructed.
  void forget(std::optional<double> wanted_stddev = {});
  /// Whether so many windows came since then that a calibration can be judged by some of them.
  bool canBeJudged() const;

 private:
  void publish();

  const Actuator nominal_;
  const CalibrationConfig config_;
  const double wanted_stddev_;
  std::unique_ptr<MotionFollower> follower_;  ///< nothing where motions tell nothing
  ros::Publisher publisher_;
};

}  // namespace sac
