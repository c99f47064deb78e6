#include "spherical_actuator_calibration/ros/calibration_node/calibration_topics.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_set>
#include <utility>
#include <vector>

#include <spherical_actuator_calibration/CalibrationStatus.h>
#include <spherical_actuator_calibration/PlanProgress.h>
#include <std_msgs/String.h>

#include "spherical_actuator_calibration/assessment/torque_linearity.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/calibration/session_guidance.hpp"
#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"
#include "spherical_actuator_calibration/planning/plan_guidance.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/progress_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/topic_names.hpp"
#include "spherical_actuator_calibration/ros/node/latched_publishing.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"

namespace sac {
namespace {

constexpr bool kLatched = true;
constexpr std::uint32_t kQueueLength = 1000;

void fillCoverage(const SessionProgress& progress, msg::CalibrationStatus& message) {
  message.joint = coverageToRos(progress.joint);
  for (const Coverage& pole : progress.poles) {
    message.poles.push_back(coverageToRos(pole));
  }
  for (const Coverage& coil : progress.coils) {
    message.coils.push_back(coverageToRos(coil));
  }
}

}  // namespace

CalibrationTopics::CalibrationTopics(ros::NodeHandle node, std::string frame)
    : frame_(std::move(frame)),
      parameters_(node.advertise<msg::ActuatorParameters>("parameters", 1, kLatched)),
      report_(node.advertise<msg::CalibrationReport>("report", 1, kLatched)),
      status_(node.advertise<msg::CalibrationStatus>("status", 1, kLatched)),
      plan_progress_(node.advertise<msg::PlanProgress>("plan_progress", 1, kLatched)),
      description_(node.advertise<std_msgs::String>(kDescriptionTopic, 1, kLatched)),
      config_(node.advertise<std_msgs::String>(kConfigTopic, 1, kLatched)),
      samples_(node.advertise<msg::CalibrationSample>("samples", kQueueLength)) {}

void CalibrationTopics::publishSetup(const CalibratedDescription& start,
                                     const CalibrationConfig& config) {
  std_msgs::String message;
  message.data = renderDescription(start, description_.getTopic());
  publishLatched(description_, message);
  message.data = renderCalibrationConfig(config);
  publishLatched(config_, message);
}

void CalibrationTopics::publishParameters(const LiveSession& session) {
  msg::ActuatorParameters message =
      parametersToRos(session.actuator(), session.calibration().stddevs());
  message.header = header();
  message.revision = session.revision().number;
  message.source = session.revision().source;
  publishLatched(parameters_, message);
}

void CalibrationTopics::publishReport(const msg::CalibrationReport& report) {
  last_report_ = report;
  publishLatched(report_, report);
}

void CalibrationTopics::dropResiduals(const std::vector<Sample>& in_use) {
  // Those of a motion are of its windows.
  if (!last_report_ || last_report_->cycle == msg::CalibrationReport::MOTION) {
    return;
  }
  std::unordered_set<std::uint32_t> ids;
  for (const Sample& sample : in_use) {
    ids.insert(sample.id);
  }
  std::vector<msg::SampleResidual>& residuals = last_report_->residuals;
  const auto dropped = std::remove_if(
      residuals.begin(), residuals.end(), [&](const auto& one) { return ids.count(one.id) == 0; });
  if (dropped != residuals.end()) {
    residuals.erase(dropped, residuals.end());
    publishLatched(report_, *last_report_);
  }
}

void CalibrationTopics::publishStatus(const LiveSession& session,
                                      const SessionProgress& progress,
                                      const GradedCalibration& graded,
                                      bool auto_capture) {
  const CalibrationSession& calibration = session.calibration();
  const EstimationOptions& estimation = calibration.config().estimation;
  const Actuator& nominal = calibration.model().space().nominal();
  msg::CalibrationStatus message;
  message.header = header();
  message.actuator = nominal.name;
  message.serial = nominal.serial;
  message.revision = session.revision().number;
  message.orientation_samples = progress.orientation_samples;
  message.torque_samples = progress.torque_samples;
  message.joint_done = static_cast<std::uint8_t>(progress.joint_done);
  message.poles_done = static_cast<std::uint8_t>(progress.poles_done);
  message.coil_done.assign(progress.coil_done.begin(), progress.coil_done.end());
  message.refined = static_cast<std::uint8_t>(progress.refined);
  fillCoverage(progress, message);
  message.current_threshold = estimation.current_threshold;
  message.least_current = leastExcitation(estimation.current_threshold);
  const CurrentTolerance tolerance = currentTolerance(estimation.current_threshold);
  message.current_tolerance = tolerance.absolute;
  message.current_tolerance_share = tolerance.share;
  message.pose_tolerance = kPoseTolerance;
  message.shortest_capture = calibration.config().samples.smallest_duration;
  message.longest_capture = calibration.config().samples.longestCapture();
  message.rest_spread =
      restOptions(calibration.config().samples, nominal.has_joints).largest_joint_spread;
  message.auto_capture = static_cast<std::uint8_t>(auto_capture);
  message.worst_stddev = calibration.worstStddev();
  for (const CycleRequest& request : progress.next_cycles) {
    message.next_cycles.push_back(cycleText(request));
  }
  message.complete = static_cast<std::uint8_t>(progress.complete);
  message.grade = gradeName(graded.grade);
  message.grade_reason = graded.reason;
  message.next_step = nextStep(calibration.model(), progress);
  if (calibration.model().hasTorqueModel()) {
    message.torque_linearity = describe(session.linearity());
    message.linearity_is_told = session.linearity() ? 1 : 0;
  }
  publishLatched(status_, message);
  if (last_report_ && (last_report_->grade != message.grade ||
                       last_report_->grade_reason != message.grade_reason)) {
    last_report_->grade = message.grade;
    last_report_->grade_reason = message.grade_reason;
    publishLatched(report_, *last_report_);
  }
}

void CalibrationTopics::publishPlan(const PlanProgress* plan) {
  msg::PlanProgress message;
  message.header = header();
  if (plan != nullptr) {
    message.poses = progressToRos(plan->poses());
  }
  publishLatched(plan_progress_, message);
}

void CalibrationTopics::publishSample(const msg::CalibrationSample& sample) {
  samples_.publish(sample);
}

msg::CalibrationReport CalibrationTopics::stamped(msg::CalibrationReport report) const {
  report.header = header();
  return report;
}

msg::CalibrationSample CalibrationTopics::sampleMessage(const Sample& sample) const {
  msg::CalibrationSample message = sampleToRos(sample);
  message.header.frame_id = frame_;
  return message;
}

std_msgs::Header CalibrationTopics::header() const {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = frame_;
  return header;
}

}  // namespace sac
