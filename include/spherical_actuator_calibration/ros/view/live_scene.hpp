#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <ros/time.h>
#include <sensor_msgs/JointState.h>

#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/CalibrationSample.h"
#include "spherical_actuator_calibration/CalibrationStatus.h"
#include "spherical_actuator_calibration/CoilCurrents.h"
#include "spherical_actuator_calibration/PlanPoses.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/sample_mirror.hpp"
#include "spherical_actuator_calibration/ros/view/calibration_markers.hpp"

namespace sac {

/// Gathers from the topics of a calibration what the live view shows of it. Messages of another
/// design (other numbers of poles or coils) change nothing.
class LiveScene {
 public:
  /// `start` holds the nominal actuator, dimensions, magnification and frames.
  explicit LiveScene(CalibrationScene start);

  void receive(const msg::ActuatorParameters& message);
  void receive(const msg::CalibrationReport& message);
  void receive(const msg::CoilCurrents& message);
  void receive(const msg::CalibrationSample& message);
  void receive(const msg::CalibrationStatus& message);
  /// The wanted pose: raw angles of all joints in their order, or none. Panel and engine both tell
  /// it, latched: of what comes in any order, the last stamp counts.
  void receive(const sensor_msgs::JointState& message);

  /// The samples in use; it asks for them where topics do not tell.
  SampleMirror& samples() { return samples_; }

  /// True when the scene has changed since the last call.
  bool takeChange();

  /// The actuator by the parameters in force.
  const Actuator& identified() const { return scene_.identified; }
  CalibrationScene scene() const;

 private:
  struct Residual {
    double standardized = 0.0;
    bool rejected = false;
  };

  SampledDirection directionOf(const msg::CalibrationSample& sample) const;

  CalibrationScene scene_;
  SampleMirror samples_;
  std::map<std::uint32_t, Residual> residuals_;  ///< of the last report, by sample
  ros::Time wanted_stamp_;
  bool changed_ = true;
};

}  // namespace sac
