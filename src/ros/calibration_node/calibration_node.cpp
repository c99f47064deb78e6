#include "spherical_actuator_calibration/ros/calibration_node/calibration_node.hpp"

#include <exception>
#include <filesystem>
#include <memory>
#include <utility>

#include <ros/console.h>

#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/version.hpp"
#include "spherical_actuator_calibration/planning/plan_guidance.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"
#include "spherical_actuator_calibration/planning/sample_places.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/progress_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/utc_date.hpp"
#include "spherical_actuator_calibration/ros/recording/report_page.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

constexpr double kSamplePeriod = 0.05;  // how often finished dwells are looked for [s]
constexpr double kMotionPeriod = 0.1;   // how often windows of a motion are looked for [s]

}  // namespace

CalibrationNode::CalibrationNode(const ros::NodeHandle& node,
                                 const ros::NodeHandle& private_node,
                                 const CalibratedDescription& start,
                                 const CalibrationNodeOptions& options)
    : node_(node),
      private_node_(private_node),
      options_(options),
      directory_(options.directory, start.actuator),
      files_(directory_),
      session_(start, options.calibration, directory_.database(), packageVersion()),
      topics_(node, options.calibration.frames.stator),
      motion_(node, start.actuator, options.calibration, options.motion_wanted_stddev),
      auto_capture_(options.auto_capture),
      intake_(node, start.actuator, options.calibration),
      diagnostics_(node, private_node, start.actuator) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  topics_.publishSetup(start, options.calibration);
  topics_.publishParameters(session_);
  if (const auto report = session_.lastReport()) {
    topics_.publishReport(topics_.stamped(reportToRos(*report, session_.grade())));
    topics_.dropResiduals(session_.calibration().samples());
  }
  takeUpPlan();
  topics_.publishPlan(plan_.get());
  publishStatus();

  takeUpMotion();
  diagnostics_.add("session", [this](DiagnosticStatus& status) { diagnose(status); });
  intake_.addDiagnostics(diagnostics_);
  advertiseServices();
  sample_timer_ = node_.createWallTimer(
      ros::WallDuration(kSamplePeriod),
      [this](const ros::WallTimerEvent& /*event*/) { takeAutomaticSamples(); });
  motion_timer_ =
      node_.createWallTimer(ros::WallDuration(kMotionPeriod),
                            [this](const ros::WallTimerEvent& /*event*/) { followMotion(); });
}

void CalibrationNode::advertiseServices() {
  const auto advertise = [this](const char* name, auto callback) {
    services_.push_back(private_node_.advertiseService(name, callback, this));
  };
  advertise("capture", &CalibrationNode::capture);
  advertise("capture_planned", &CalibrationNode::capturePlanned);
  advertise("linearity_captures", &CalibrationNode::linearityCaptures);
  advertise("list_samples", &CalibrationNode::listSamples);
  advertise("remove_sample", &CalibrationNode::removeSample);
  advertise("set_auto_capture", &CalibrationNode::setAutoCapture);
  advertise("clear_samples", &CalibrationNode::clearSamples);
  advertise("calibrate_joint", &CalibrationNode::calibrateJoint);
  advertise("calibrate_poles", &CalibrationNode::calibratePoles);
  advertise("calibrate_coil", &CalibrationNode::calibrateCoil);
  advertise("refine", &CalibrationNode::refine);
  advertise("calibrate_motion", &CalibrationNode::calibrateMotion);
  advertise("begin_motion", &CalibrationNode::beginMotion);
  advertise("forget_motion", &CalibrationNode::forgetMotion);
  advertise("validate", &CalibrationNode::validate);
  advertise("diagnose", &CalibrationNode::explainSamples);
  advertise("check", &CalibrationNode::checkParameters);
  advertise("plan_poses", &CalibrationNode::planPoses);
  advertise("draw_validation_poses", &CalibrationNode::drawValidationPoses);
  advertise("load_plan", &CalibrationNode::loadPlan);
  advertise("missing_patterns", &CalibrationNode::missingPatterns);
  advertise("reset", &CalibrationNode::reset);
  advertise("restore", &CalibrationNode::restore);
  advertise("save", &CalibrationNode::save);
}

bool CalibrationNode::capture(msg::Capture::Request& request, msg::Capture::Response& response) {
  const CaptureProgress progress = intake_.waitForCapture(
      request.duration == 0.0 ? options_.capture_duration : request.duration);
  if (!progress.sample) {
    response.message = "No sample: " + progress.message;
    return true;
  }
  answer(response, [&] {
    Sample sample = *progress.sample;
    sample.validation = request.validation != 0;
    sample = store(sample);
    response.sample = topics_.sampleMessage(sample);
    return "Sample " + std::to_string(sample.id) + " is stored." +
           (progress.message.empty() ? "" : " " + progress.message);
  });
  return true;
}

bool CalibrationNode::listSamples(msg::ListSamples::Request& /*request*/,
                                  msg::ListSamples::Response& response) {
  std::vector<Sample> samples;
  {
    const std::lock_guard<std::mutex> lock(session_mutex_);
    samples = session_.calibration().samples();
  }
  // The configuration never changes while the node runs.
  const double threshold = options_.calibration.estimation.current_threshold;
  SamplePlaces places;
  for (const Sample& sample : samples) {
    response.samples.push_back(topics_.sampleMessage(sample));
    response.excited.push_back(patternToRos(patternOf(sample, threshold)));
    response.places.push_back(static_cast<std::uint32_t>(numberOf(places.placeOf(sample))));
  }
  return true;
}

bool CalibrationNode::removeSample(msg::RemoveSample::Request& request,
                                   msg::RemoveSample::Response& response) {
  answer(response, [&] {
    const std::vector<Sample>& samples = session_.calibration().samples();
    const bool is_held_out = std::any_of(samples.begin(), samples.end(), [&](const Sample& one) {
      return one.id == request.id && one.validation;
    });
    if (!session_.removeSample(request.id, utcDate())) {
      throw DataError("Sample " + std::to_string(request.id) +
                      " is not in use: list_samples shows those that are.");
    }
    if (plan_) {
      plan_->countAnew(session_.calibration().samples());
      topics_.publishPlan(plan_.get());
    }
    topics_.dropResiduals(session_.calibration().samples());
    publishStatus();
    return "Sample " + std::to_string(request.id) +
           (is_held_out ? " is out of use: the other held-out samples judge without it."
                        : " is out of use; run the cycles again to be rid of its effect.");
  });
  return true;
}

bool CalibrationNode::setAutoCapture(std_srvs::SetBool::Request& request,
                                     std_srvs::SetBool::Response& response) {
  answer(response, [&] {
    auto_capture_ = request.data != 0;
    publishStatus();
    return auto_capture_ ? "Every dwell is captured by itself from now on."
                         : "Dwells are captured on request only.";
  });
  return true;
}

bool CalibrationNode::clearSamples(std_srvs::Trigger::Request& /*request*/,
                                   std_srvs::Trigger::Response& response) {
  answer(response, [&] {
    const std::size_t count = session_.clearSamples(utcDate());
    beginMotionAnew();
    plan_ = nullptr;
    topics_.publishPlan(nullptr);
    topics_.dropResiduals({});
    publishStatus();
    return std::to_string(count) + " samples are out of use; they stay in the session database.";
  });
  return true;
}

bool CalibrationNode::calibrateJoint(msg::Calibrate::Request& /*request*/,
                                     msg::Calibrate::Response& response) {
  run({Cycle::kJoint}, response);
  return true;
}

bool CalibrationNode::calibratePoles(msg::Calibrate::Request& request,
                                     msg::Calibrate::Response& response) {
  run({Cycle::kPoles, indexOf(request.coil)}, response);
  return true;
}

bool CalibrationNode::calibrateCoil(msg::Calibrate::Request& request,
                                    msg::Calibrate::Response& response) {
  run({Cycle::kCoil, indexOf(request.coil)}, response);
  return true;
}

bool CalibrationNode::refine(msg::Calibrate::Request& /*request*/,
                             msg::Calibrate::Response& response) {
  run({Cycle::kRefine}, response);
  return true;
}

void CalibrationNode::run(const CycleRequest& request,
                          msg::Calibrate::Response& response,
                          std::shared_ptr<const MotionRecording> motion) {
  answer(response, [&] {
    storeWaitingSamples();
    refuseMistakes(request, response);
    session_.setMotion(std::move(motion));
    const CycleReport report = session_.run(request, utcDate());
    response.report = topics_.stamped(reportToRos(report, session_.grade()));
    if (!report.success) {
      explainFailure(response.report);
    }
    topics_.publishReport(response.report);
    if (report.success) {
      topics_.publishParameters(session_);
      if (request.cycle == Cycle::kRefine) {
        plan_ = nullptr;
        topics_.publishPlan(nullptr);
      }
    }
    publishStatus();
    if (!report.success) {
      throw DataError(response.report.message);
    }
    return report.message;
  });
}

bool CalibrationNode::validate(msg::Calibrate::Request& /*request*/,
                               msg::Calibrate::Response& response) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  const CalibrationSession& calibration = session_.calibration();
  const HeldOutValidation validation = calibration.validation().value_or(HeldOutValidation{});
  response.report = topics_.stamped(validationToRos(validation, session_.grade()));
  response.success = response.report.success;
  response.message = response.report.message;
  return true;
}

bool CalibrationNode::reset(std_srvs::Trigger::Request& /*request*/,
                            std_srvs::Trigger::Response& response) {
  answer(response, [&] {
    session_.reset(utcDate());
    topics_.publishParameters(session_);
    publishStatus();
    return "The nominal parameters are in force, as revision " +
           std::to_string(session_.revision().number) + ".";
  });
  return true;
}

bool CalibrationNode::restore(msg::Restore::Request& request, msg::Restore::Response& response) {
  answer(response, [&] {
    session_.restore(request.revision, utcDate());
    topics_.publishParameters(session_);
    publishStatus();
    return "The parameters of revision " + std::to_string(request.revision) +
           " are in force again, as revision " + std::to_string(session_.revision().number) + ".";
  });
  return true;
}

bool CalibrationNode::save(std_srvs::Trigger::Request& /*request*/,
                           std_srvs::Trigger::Response& response) {
  std::string report_folder;
  answer(response, [&] {
    const std::string message = files_.save(session_, robotDescription());
    report_folder = files_.saveReport(session_);
    publishStatus();
    return message + " Grade: " + gradeName(session_.grade().grade) + ". " +
           session_.grade().reason;
  });
  // Nothing waits for the page: the session is free again.
  if (response.success != 0 && options_.report_page) {
    const std::string page = (fs::path(report_folder) / "report.html").string();
    const std::string failure =
        writeReportPage((fs::path(report_folder) / "report.yaml").string(), page);
    response.message += failure.empty() ? " Report: " + page + "." : " " + failure;
  }
  return true;
}

RobotDescription CalibrationNode::robotDescription() const {
  RobotDescription robot;
  robot.source = node_.resolveName("robot_description");
  std::string urdf;
  if (node_.getParam(robot.source, urdf)) {
    robot.urdf = urdf;
  }
  return robot;
}

void CalibrationNode::takeAutomaticSamples() {
  std::vector<Sample> samples;
  try {
    samples = intake_.takeSamples();
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("Dwells cannot be evaluated: " << error.what());
  }
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (auto_capture_) {
    keep(samples);
  }
  try {
    storeWaitingSamples();
  } catch (const std::exception& error) {
    last_error_ = error.what();
    constexpr double kSilence = 10.0;  // [s]
    ROS_ERROR_STREAM_THROTTLE(kSilence,
                              waiting_.size() << " samples wait to be stored: " << error.what());
  }
}

void CalibrationNode::keep(const std::vector<Sample>& samples) {
  for (const Sample& sample : samples) {
    try {
      session_.calibration().prepared(sample);
      waiting_.push_back(sample);
    } catch (const std::exception& error) {
      last_error_ = error.what();
      ROS_ERROR_STREAM("A dwell gave no sample: " << error.what());
    }
  }
}

// In the order of their capture; one that cannot be stored stays, and so do those behind it.
void CalibrationNode::storeWaitingSamples() {
  while (!waiting_.empty()) {
    store(waiting_.front());
    waiting_.pop_front();
  }
}

Sample CalibrationNode::store(const Sample& sample) {
  const std::size_t before = session_.calibration().samples().size();
  Sample stored = session_.addSample(sample, utcDate());
  const bool is_new = session_.calibration().samples().size() > before;
  if (plan_ && is_new && plan_->add(stored)) {
    topics_.publishPlan(plan_.get());
  }
  topics_.publishSample(topics_.sampleMessage(stored));
  publishStatus();
  return stored;
}

// What it tells of is stored by then: that it cannot be told makes no service fail.
void CalibrationNode::publishStatus() {
  try {
    SessionProgress progress = session_.progress();
    const GradedCalibration& graded = session_.grade();
    progress.saved = files_.isSaved(session_.revision().number, graded.grade);
    progress.contradicted = graded.grade == Grade::kContradicted;
    progress.good = graded.grade == Grade::kGood;
    progress.judged = progress.good || graded.grade == Grade::kUsable;
    if (plan_) {
      progress.plan_step = plan_->nextStep();
    }
    if (progress.plan_step.empty()) {
      progress.plan_step = motionStep(progress);
    }
    topics_.publishStatus(session_, progress, graded, auto_capture_);
  } catch (const std::exception& error) {
    last_error_ = error.what();
    ROS_ERROR_STREAM("The status cannot be published: " << error.what());
  }
}

void CalibrationNode::diagnose(DiagnosticStatus& status) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  const GradedCalibration& graded = session_.grade();
  if (waiting_.empty() && waiting_windows_.empty()) {
    const bool is_contradicted = graded.grade == Grade::kContradicted;
    status.summary(is_contradicted ? DiagnosticStatus::WARN : DiagnosticStatus::OK,
                   is_contradicted ? printable(graded.reason) : "samples and windows are stored");
  } else {
    status.summaryf(DiagnosticStatus::ERROR,
                    "%zu samples and %zu windows of a motion wait to be stored: %s",
                    waiting_.size(),
                    waiting_windows_.size(),
                    last_error_.c_str());
  }
  status.add("grade", gradeName(graded.grade));
  status.add("revision", session_.revision().number);
  status.add("samples in use", session_.calibration().samples().size());
  status.add("automatic capture", auto_capture_ ? "on" : "off");
  status.add("directory", directory_.path());
  addTextOrNone(status, "last error", last_error_);
}

}  // namespace sac
