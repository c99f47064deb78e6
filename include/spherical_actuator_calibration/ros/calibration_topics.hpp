#pragma once

#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "spherical_actuator_calibration/core/session_guidance.hpp"
#include "spherical_actuator_calibration/ros/msg_conversion.hpp"
#include "spherical_actuator_calibration/storage/live_session.hpp"

namespace spherical_actuator_calibration {

/// What the calibration node publishes: `parameters`, `report` and `status`, latched, and
/// `samples`.
class CalibrationTopics {
 public:
  /// `frame`: name of the stator frame.
  CalibrationTopics(ros::NodeHandle node, std::string frame);

  void publishParameters(const LiveSession& session);
  void publishReport(const CalibrationReport& report);
  void publishStatus(const LiveSession& session,
                     const SessionProgress& progress,
                     const std::string& next_step);
  void publishSample(const CalibrationSample& sample);

  /// Messages with their header, stamped now where they have no time of their own.
  CalibrationReport stamped(CalibrationReport report) const;
  CalibrationSample sampleMessage(const Sample& sample) const;

 private:
  std_msgs::Header header() const;

  std::string frame_;
  ros::Publisher parameters_;
  ros::Publisher report_;
  ros::Publisher status_;
  ros::Publisher samples_;
};

}  // namespace spherical_actuator_calibration
