#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/wall_timer.h>
#include <spherical_actuator_calibration/BeginMotion.h>
#include <spherical_actuator_calibration/Capture.h>
#include <spherical_actuator_calibration/CapturePlanned.h>
#include <spherical_actuator_calibration/Diagnose.h>
#include <spherical_actuator_calibration/DrawValidationPoses.h>
#include <spherical_actuator_calibration/LinearityCaptures.h>
#include <spherical_actuator_calibration/ListSamples.h>
#include <spherical_actuator_calibration/LoadPlan.h>
#include <spherical_actuator_calibration/MissingPatterns.h>
#include <spherical_actuator_calibration/RemoveSample.h>
#include <spherical_actuator_calibration/Restore.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/CalibrationReport.h"
#include "spherical_actuator_calibration/PlanPoses.h"
#include "spherical_actuator_calibration/ros/calibration_node/calibration_node_options.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/calibration_topics.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/measurement_intake.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/motion_watch.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/service_answer.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/storage/calibration_directory.hpp"
#include "spherical_actuator_calibration/storage/calibration_files.hpp"
#include "spherical_actuator_calibration/storage/live_session.hpp"

namespace sac {

class PlanProgress;
struct PoseToMeasure;

/// The calibration of one unit while it is measured: takes samples on request or by itself, runs
/// the cycles, keeps everything in the session database, and publishes the parameters in force.
///
/// Measurements are received in a thread of their own. Services are served by any number of
/// threads; those that touch the session take turns.
class CalibrationNode {
 public:
  /// Takes up the session in the calibration directory and publishes its parameters. `node` is in
  /// the namespace of the actuator. Throws ConfigError and DataError when description, options or
  /// directory cannot be used.
  CalibrationNode(const ros::NodeHandle& node,
                  const ros::NodeHandle& private_node,
                  const CalibratedDescription& start,
                  const CalibrationNodeOptions& options);
  CalibrationNode(const CalibrationNode&) = delete;
  CalibrationNode& operator=(const CalibrationNode&) = delete;

 private:
  void advertiseServices();

  // Samples.
  bool capture(msg::Capture::Request& request, msg::Capture::Response& response);
  bool capturePlanned(msg::CapturePlanned::Request& request,
                      msg::CapturePlanned::Response& response);
  bool listSamples(msg::ListSamples::Request& request, msg::ListSamples::Response& response);
  bool removeSample(msg::RemoveSample::Request& request, msg::RemoveSample::Response& response);
  bool setAutoCapture(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool clearSamples(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  // Cycles.
  bool calibrateJoint(msg::Calibrate::Request& request, msg::Calibrate::Response& response);
  bool calibratePoles(msg::Calibrate::Request& request, msg::Calibrate::Response& response);
  bool calibrateCoil(msg::Calibrate::Request& request, msg::Calibrate::Response& response);
  bool refine(msg::Calibrate::Request& request, msg::Calibrate::Response& response);
  bool validate(msg::Calibrate::Request& request, msg::Calibrate::Response& response);
  bool planPoses(msg::PlanPoses::Request& request, msg::PlanPoses::Response& response);
  bool drawValidationPoses(msg::DrawValidationPoses::Request& request,
                           msg::DrawValidationPoses::Response& response);
  bool loadPlan(msg::LoadPlan::Request& request, msg::LoadPlan::Response& response);
  /// Keeps a plan and follows it; the caller holds the session.
  void adopt(const std::vector<PoseToMeasure>& poses);
  bool missingPatterns(msg::MissingPatterns::Request& request,
                       msg::MissingPatterns::Response& response);
  bool linearityCaptures(msg::LinearityCaptures::Request& request,
                         msg::LinearityCaptures::Response& response);
  /// What of a plan is left to be measured.
  void followPlan(const std::vector<PoseToMeasure>& poses);
  /// The plan that was followed before a restart.
  void takeUpPlan();
  void run(const CycleRequest& request,
           msg::Calibrate::Response& response,
           std::shared_ptr<const MotionRecording> motion = nullptr);

  // Motion (calibration_node_motion.cpp).
  bool calibrateMotion(msg::Calibrate::Request& request, msg::Calibrate::Response& response);
  bool beginMotion(msg::BeginMotion::Request& request, msg::BeginMotion::Response& response);
  bool forgetMotion(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void takeUpMotion();
  void followMotion();
  /// Whether a motion goes on, by the windows that came now; tells it where that changed.
  void noteMotion(std::size_t windows);
  /// What to do about a motion next; nothing: there is none.
  std::string motionStep(const SessionProgress& progress) const;
  void storeWaitingWindows();
  /// Precondition: session_mutex_ is held. `wanted_stddev`: of the next one [rad]; nothing: the
  /// configured one.
  void beginMotionAnew(std::optional<double> wanted_stddev = {});

  // What does not fit, and why (calibration_node_diagnosis.cpp).
  bool explainSamples(msg::Diagnose::Request& request, msg::Diagnose::Response& response);
  bool checkParameters(msg::Diagnose::Request& request, msg::Diagnose::Response& response);
  /// Throws DataError, with the report of a refused cycle in the response, when no cycle has
  /// succeeded yet and the samples tell of a mistake of wiring.
  void refuseMistakes(const CycleRequest& request, msg::Calibrate::Response& response);
  /// Adds what explains a failed cycle to its report.
  void explainFailure(msg::CalibrationReport& report);

  // Parameters.
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool restore(msg::Restore::Request& request, msg::Restore::Response& response);
  bool save(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  void takeAutomaticSamples();
  void keep(const std::vector<Sample>& samples);
  void storeWaitingSamples();
  Sample store(const Sample& sample);
  /// The parameter robot_description.
  RobotDescription robotDescription() const;
  void publishStatus();
  void diagnose(DiagnosticStatus& status);
  /// Answers a service that touches the session: see answerService().
  template <typename Response, typename Action>
  void answer(Response& response, Action action) {
    answerService(session_mutex_, last_error_, response, action);
  }

  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  const CalibrationNodeOptions options_;

  std::mutex session_mutex_;  ///< of everything down to motion_
  const CalibrationDirectory directory_;
  const CalibrationFiles files_;
  LiveSession session_;
  std::deque<Sample> waiting_;  ///< captured by itself, not stored yet: the disk did not take it
  std::string last_error_;
  /// That was asked for last, also before a restart, until it is done or out of use; nothing
  /// without one. Behind a pointer, so that not all who use the node compile the planner.
  std::shared_ptr<PlanProgress> plan_;
  CalibrationTopics topics_;
  MotionWatch motion_;
  bool is_in_motion_ = false;
  std::size_t windows_in_a_row_ = 0;          ///< without a rest
  double last_window_ = 0.0;                  ///< when it came, by a clock that never jumps [s]
  std::vector<MotionSlice> stored_windows_;   ///< of a session that is taken up: not followed yet
  std::vector<MotionSlice> waiting_windows_;  ///< not stored yet: the disk did not take them

  std::atomic<bool> auto_capture_;
  MeasurementIntake intake_;

  NodeDiagnostics diagnostics_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer sample_timer_;
  ros::WallTimer motion_timer_;
};

}  // namespace sac
