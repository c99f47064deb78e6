#pragma once

#include <optional>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/calibration/session_progress.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/storage/live_session.hpp"

namespace sac {

class PlanProgress;

/// What the calibration node publishes: `parameters`, `report`, `status`, `plan_progress`, and what
/// the session rests on (`calibration_description`, `calibration_config`), latched, and `samples`.
class CalibrationTopics {
 public:
  /// `frame`: name of the stator frame.
  CalibrationTopics(ros::NodeHandle node, std::string frame);

  /// Description and configuration at the start of the session: with them its recording can be
  /// calibrated again with nothing beside it.
  void publishSetup(const CalibratedDescription& start, const CalibrationConfig& config);
  void publishParameters(const LiveSession& session);
  void publishReport(const msg::CalibrationReport& report);
  /// The last report once more, where it has residuals of samples that are not in use any more:
  /// without these.
  void dropResiduals(const std::vector<Sample>& in_use);
  /// Publishes the last report once more where its grade is another one now.
  void publishStatus(const LiveSession& session,
                     const SessionProgress& progress,
                     const GradedCalibration& graded,
                     bool auto_capture);
  /// `plan`: null where there is none.
  void publishPlan(const PlanProgress* plan);
  void publishSample(const msg::CalibrationSample& sample);

  /// Messages with their header, stamped now where they have no time of their own.
  msg::CalibrationReport stamped(msg::CalibrationReport report) const;
  msg::CalibrationSample sampleMessage(const Sample& sample) const;

 private:
  std_msgs::Header header() const;

  std::string frame_;
  std::optional<msg::CalibrationReport> last_report_;
  ros::Publisher parameters_;
  ros::Publisher report_;
  ros::Publisher status_;
  ros::Publisher plan_progress_;
  ros::Publisher description_;
  ros::Publisher config_;
  ros::Publisher samples_;
};

}  // namespace sac
