#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <ros/console.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"
#include "spherical_actuator_calibration/measurement/validation_poses.hpp"
#include "spherical_actuator_calibration/planning/linearity_plan.hpp"
#include "spherical_actuator_calibration/planning/plan_guidance.hpp"
#include "spherical_actuator_calibration/planning/planned_capture.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"
#include "spherical_actuator_calibration/planning/session_plan_file.hpp"
#include "spherical_actuator_calibration/planning/session_plan_record.hpp"
#include "spherical_actuator_calibration/planning/time_budget.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/calibration_node.hpp"
#include "spherical_actuator_calibration/ros/conversion/plan_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/progress_conversion.hpp"
#include "spherical_actuator_calibration/storage/earlier_session.hpp"

namespace sac {
namespace {

/// The cycle that a plan is asked for; the refinement where none is named.
CycleRequest plannedCycle(const msg::PlanPoses::Request& request) {
  for (const Cycle cycle : {Cycle::kJoint, Cycle::kPoles, Cycle::kCoil, Cycle::kRefine}) {
    const bool needs_coil = cycle == Cycle::kPoles || cycle == Cycle::kCoil;
    if (request.cycle == cycleName(cycle) || (request.cycle.empty() && cycle == Cycle::kRefine)) {
      return {cycle, needs_coil ? indexOf(request.coil) : std::nullopt};
    }
  }
  throw ConfigError("cycle: " + request.cycle + " is none; joint, poles, coil and refine are.");
}

/// Of an excited coil [A]: a weaker one does not count as excited.
ValueRange excitationRange(const CalibrationSession& calibration) {
  constexpr double kLargestCurrent = 1000.0;  // [A]
  const double threshold = calibration.config().estimation.current_threshold;
  return ValueRange::closed(leastExcitation(threshold), kLargestCurrent, "A");
}

/// Throws ConfigError for what is no pattern of an actuator with so many coils, and for a current
/// beyond the range.
PlannedCapture plannedCapture(const msg::CapturePlanned::Request& request,
                              std::size_t coils,
                              const ValueRange& range) {
  PlannedCapture planned;
  planned.joint_position = Eigen::Vector3d(request.joint_position.data());
  planned.pattern = patternFromRos(request.coils, coils);
  if (!planned.pattern.empty()) {
    requireInRange("current", request.current, range);
    planned.current = request.current;
  }
  return planned;
}

void addPoses(const PosePlan& plan, bool validation, PosesToMeasure& poses) {
  for (const PlannedPose& pose : plan.poses) {
    poses.push_back({pose.joint_position, pose.excitations(), validation});
  }
}

/// Of an earlier session, or of the plan of one. `database`: that of the present session.
EarlierSession posesOfFile(const std::string& path,
                           const CalibrationSession& calibration,
                           const std::string& database) {
  const Actuator& nominal = calibration.start().actuator;
  std::error_code ignored;
  if (std::filesystem::equivalent(path, database, ignored)) {
    throw ConfigError(path + ": that is the session which goes on, not an earlier one.");
  }
  EarlierSession poses;
  if (isDatabase(path)) {
    poses = loadEarlierSession(path, nominal, calibration.config().estimation.current_threshold);
  } else {
    const SessionPlanRecord record = loadSessionPlanFor(nominal, path);
    addPoses(record.plan, false, poses.poses);
    poses.current = record.current;
  }
  const bool excites = std::any_of(poses.poses.begin(), poses.poses.end(), [](const auto& pose) {
    return !pose.patterns.empty();
  });
  if (excites) {
    requireInRange(path + ": the current of a coil", poses.current, excitationRange(calibration));
  }
  return poses;
}

}  // namespace

bool CalibrationNode::capturePlanned(msg::CapturePlanned::Request& request,
                                     msg::CapturePlanned::Response& response) {
  try {
    // The start and the configuration never change while the node runs.
    const CalibrationSession& calibration = session_.calibration();
    const double threshold = calibration.config().estimation.current_threshold;
    const PlannedCapture planned = plannedCapture(
        request, calibration.start().actuator.coils.size(), excitationRange(calibration));
    const Eigen::VectorXd measured = intake_.currents();
    if (!planned.pattern.empty() && measured.size() == 0) {
      response.flaw = flawName(CaptureFlaw::kExcitation);
      response.message = "No currents are measured: check the coil driver.";
      return true;
    }
    if (const auto coil = coilAmiss(planned, measured, threshold)) {
      response.flaw = flawName(CaptureFlaw::kExcitation);
      response.message = amissInWords(planned, *coil);
      return true;
    }
    const double duration = request.duration == 0.0 ? options_.capture_duration : request.duration;
    const CaptureProgress progress = intake_.waitForCapture(
        captureDuration(planned, duration, options_.calibration.samples.longestCapture()));
    if (!progress.sample) {
      response.message = "No sample: " + progress.message;
      return true;
    }
    Sample sample = *progress.sample;
    sample.validation = request.validation != 0;
    const std::lock_guard<std::mutex> lock(session_mutex_);
    const CaptureFlaw flaw = captureFlaw(sample, planned, calibration.samples(), threshold);
    if (flaw != CaptureFlaw::kNone) {
      response.flaw = flawName(flaw);
      response.message = flawInWords(flaw);
      return true;
    }
    sample = store(sample);
    response.sample = topics_.sampleMessage(sample);
    response.message = "Sample " + std::to_string(sample.id) + " is stored." +
                       (progress.message.empty() ? "" : " " + progress.message);
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = printable(error.what());
  }
  return true;
}

/// What of a plan is left to be measured; the caller holds the session, or is alone with it.
void CalibrationNode::followPlan(const PosesToMeasure& poses) {
  const CalibrationSession& calibration = session_.calibration();
  plan_ = nullptr;
  if (poses.empty()) {
    return;
  }
  plan_ = std::make_shared<PlanProgress>(calibration.config().estimation.current_threshold,
                                         calibration.model().space().joints() > 0);
  for (const PoseToMeasure& pose : poses) {
    plan_->addPose({pose.joint_position, pose.patterns, pose.validation});
  }
  plan_->countAnew(calibration.samples());
}

/// One that cannot be read keeps nobody from calibrating.
void CalibrationNode::takeUpPlan() {
  try {
    followPlan(session_.plan());
  } catch (const std::exception& error) {
    last_error_ = printable(error.what());
    ROS_WARN_STREAM("The plan of before is not followed, plan again: " << last_error_);
  }
}

// Of many poses it takes a while: samples are copied, so that nothing waits for it.
bool CalibrationNode::missingPatterns(msg::MissingPatterns::Request& request,
                                      msg::MissingPatterns::Response& response) {
  try {
    // The start never changes while the node runs.
    const CalibrationSession& calibration = session_.calibration();
    const Actuator& nominal = calibration.start().actuator;
    PlanProgress progress(calibration.config().estimation.current_threshold);
    for (const msg::PosePatterns& message : request.poses) {
      PoseToMeasure pose = poseFromRos(message, nominal.coils.size());
      requireInWorkspace(pose.joint_position, nominal.workspace);
      progress.addPose(std::move(pose));
    }
    std::vector<Sample> samples;
    {
      const std::lock_guard<std::mutex> lock(session_mutex_);
      samples = calibration.samples();
    }
    progress.countAnew(samples);
    response.poses = progressToRos(progress.poses());
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = printable(error.what());
  }
  return true;
}

bool CalibrationNode::linearityCaptures(msg::LinearityCaptures::Request& request,
                                        msg::LinearityCaptures::Response& response) {
  try {
    const CalibrationSession& calibration = session_.calibration();
    const PoseToMeasure pose = poseFromRos(request.pose, calibration.start().actuator.coils.size());
    requireInWorkspace(pose.joint_position, calibration.start().actuator.workspace);
    if (!pose.patterns.empty()) {
      requireInRange("current", request.current, excitationRange(calibration));
    }
    const std::lock_guard<std::mutex> lock(session_mutex_);
    if (!session_.linearity()) {
      const LinearityPlan plan = linearityPlan(calibration.samples(),
                                               pose,
                                               request.current,
                                               calibration.config().estimation.current_threshold);
      response.captures = static_cast<std::uint32_t>(plan.captures);
      for (const PlannedCapture& capture : plan.missing) {
        response.patterns.push_back(patternToRos(capture.pattern));
        response.currents.push_back(capture.current);
      }
    }
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = printable(error.what());
  }
  return true;
}

// Planning takes seconds: it works on a copy, so that nothing waits for it.
bool CalibrationNode::planPoses(msg::PlanPoses::Request& request,
                                msg::PlanPoses::Response& response) {
  try {
    PosePlanOptions plan_options = planOptionsFromRos(request);
    plan_options.is_time_up = timeIsUpAfter(request.time_budget);
    PlanningProblem problem;
    problem.request = plannedCycle(request);
    std::optional<CalibrationModel> model;  // a cycle may put another one in force meanwhile
    std::vector<Sample> held;
    {
      const std::lock_guard<std::mutex> lock(session_mutex_);
      const CalibrationSession& calibration = session_.calibration();
      model = calibration.model();
      problem.model = &*model;
      problem.state = calibration.state();
      problem.estimation = calibration.config().estimation;
      held = calibration.samples();
      plan_options.start =
          held.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : held.back().joint_position;
    }
    PosesToMeasure poses;
    for (const msg::PosePatterns& pose : request.first) {
      poses.push_back(poseFromRos(pose, problem.model->space().coils()));
      requireInWorkspace(poses.back().joint_position, problem.model->space().nominal().workspace);
    }
    problem.held = &held;
    plan_options = withMeasuredNoise(std::move(plan_options), held);
    const PosePlan plan = sac::planPoses(problem, plan_options);
    response = planToRos(plan, plan_options.current, problem.model->space().coils());
    addPoses(plan, request.validation != 0, poses);
    const std::lock_guard<std::mutex> lock(session_mutex_);
    adopt(poses);
  } catch (const std::exception& error) {
    response.success = 0;
    response.message = printable(error.what());
  }
  return true;
}

// The start never changes while the node runs.
bool CalibrationNode::drawValidationPoses(msg::DrawValidationPoses::Request& request,
                                          msg::DrawValidationPoses::Response& response) {
  try {
    const Actuator& nominal = session_.calibration().start().actuator;
    const ValidationPoseOptions wanted = {request.poses, request.coils_per_pose, request.seed};
    for (const PoseToMeasure& pose : sac::drawValidationPoses(nominal, wanted)) {
      response.poses.push_back(poseToRos(pose));
    }
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = printable(error.what());
  }
  return true;
}

bool CalibrationNode::loadPlan(msg::LoadPlan::Request& request, msg::LoadPlan::Response& response) {
  try {
    // Model and configuration never change while the node runs.
    const EarlierSession plan =
        posesOfFile(request.path, session_.calibration(), session_.database().path());
    answer(response, [&] {
      adopt(plan.poses);
      response.current = plan.current;
      for (const PoseToMeasure& pose : plan.poses) {
        response.poses.push_back(poseToRos(pose));
      }
      return "Planned as in " + request.path + ": " + counted(plan.poses.size(), "pose") + ".";
    });
  } catch (const std::exception& error) {
    response.message = printable(error.what());
  }
  return true;
}

void CalibrationNode::adopt(const PosesToMeasure& poses) {
  session_.setPlan(poses);
  followPlan(poses);
  topics_.publishPlan(plan_.get());
  publishStatus();
}

}  // namespace sac
