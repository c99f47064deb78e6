#include "spherical_actuator_calibration/ros/calibration_node/measurement_intake.hpp"

#include <array>
#include <cstdint>
#include <exception>
#include <string>
#include <utility>

#include <ros/init.h>
#include <ros/this_node.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/measurement/carried_currents.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/progress_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"

namespace sac {
namespace {

/// Messages that may wait while the receiving thread is held up: seconds at the highest rates. What
/// is too long for its stream is refused faster than it can come, so that it does not pile up.
constexpr std::uint32_t kIntakeQueueLength = 10000;

/// A stream that is absent, such as a tracker which is switched off, is told but is no error of the
/// calibration; what is too old or too slow for a dwell is.
constexpr StreamLimits kLimits = {20.0, 0.5};

/// Nothing came for so long while this process ran: the streams have ended [s].
constexpr double kStreamsEnded = 2.0;

constexpr double kCapturePoll = 0.01;  // [s]

/// Currents are those of now for so long; drivers measure them at 20 Hz and more [s].
constexpr double kLatest = 1.0;

}  // namespace

MeasurementIntake::MeasurementIntake(const ros::NodeHandle& node,
                                     const Actuator& nominal,
                                     const CalibrationConfig& config)
    : has_joints_(nominal.has_joints),
      coils_(modelledCoils(nominal)),
      current_threshold_(config.estimation.current_threshold),
      merger_(config.samples.clock_reset),
      builder_(config.samples, modelledCoils(nominal), nominal.has_joints),
      motion_(modelledCoils(nominal)),
      slicer_(modelledCoils(nominal), MotionOptions()),
      reader_(nominal, config.frames),
      joints_("joint_states", kLimits),
      orientations_("measured_orientation", kLimits),
      torques_("measured_torque", kLimits),
      currents_("coil_currents", kLimits),
      node_(node),
      receiver_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  if (has_joints_) {
    subscribe<sensor_msgs::JointState>(joints_);
  }
  subscribe<geometry_msgs::QuaternionStamped>(orientations_);
  subscribe<geometry_msgs::Vector3Stamped>(torques_);
  subscribe<msg::CoilCurrents>(currents_);
  if (has_joints_) {
    subscribeCommands();
  }
  coil_check_ = node_.advertiseService(
      ros::this_node::getName() + "/check_coils", &MeasurementIntake::checkCoils, this);
  receiver_.start();
}

MeasurementIntake::~MeasurementIntake() {
  receiver_.stop();
}

// The topics have the names of their streams.
template <typename Message>
void MeasurementIntake::subscribe(StreamMonitor& monitor) {
  const auto refuse = [&monitor](const std::string& reason) { monitor.refuse(reason); };
  const auto receive = [this, &monitor](const typename Message::ConstPtr& message) {
    ++received_;
    if (const auto* measurement = reader_.read(*message)) {
      merge(*measurement);
    } else {
      monitor.refuse(reader_.refusal());
    }
  };
  subscribers_.push_back(subscribeChecked<Message>(node_,
                                                   monitor.getName(),
                                                   kIntakeQueueLength,
                                                   receive,
                                                   refuse,
                                                   ros::TransportHints().tcpNoDelay()));
}

// They tell what currents do between samples, and are not waited for. What a driver has set tells
// it better than what it was asked for.
void MeasurementIntake::subscribeCommands() {
  subscribeCommands("coil_command", [this](const CurrentCommand& command) {
    if (steadySeconds() - setpoints_arrived_ > kStreamsEnded) {
      motion_.add(command);
    }
  });
  subscribeCommands("coil_setpoints", [this](const CurrentCommand& setpoints) {
    if (isOfCoils(setpoints.current)) {
      setpoints_arrived_ = steadySeconds();
      motion_.add(setpoints);
    }
  });
}

void MeasurementIntake::subscribeCommands(
    const char* topic, const std::function<void(const CurrentCommand& command)>& take) {
  const auto receive = [this, take](const msg::CoilCurrents::ConstPtr& message) {
    const CurrentCommand& command = reader_.readCommand(*message);
    const std::lock_guard<std::mutex> lock(mutex_);
    take(command);
  };
  subscribers_.push_back(subscribeChecked<msg::CoilCurrents>(node_,
                                                             topic,
                                                             kIntakeQueueLength,
                                                             receive,
                                                             tellRefusal(topic),
                                                             ros::TransportHints().tcpNoDelay()));
}

std::vector<Sample> MeasurementIntake::takeSamples() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (haveStreamsEnded()) {
    finish();
  }
  buildInOrder();
  return builder_.takeSamples();
}

bool MeasurementIntake::haveStreamsEnded() {
  if (arrivals_.look(received_, steadySeconds())) {
    finished_ = false;
    return false;
  }
  return !finished_ && arrivals_.silence() > kStreamsEnded;
}

void MeasurementIntake::finish() {
  while (const auto measurement = merger_.nextAtOnce()) {
    build(*measurement);
  }
  builder_.finish();
  finished_ = true;
}

CaptureProgress MeasurementIntake::waitForCapture(double duration) const {
  const Stamp from = newest().value_or(0);
  ArrivalWatch arrivals(received_, steadySeconds());
  for (;;) {
    CaptureProgress progress = capture(from, duration);
    if (progress.state != CaptureProgress::State::kWaiting) {
      return progress;
    }
    if (!ros::ok() || terminationRequested()) {
      return {CaptureProgress::State::kRefused, std::nullopt, "The node is being shut down."};
    }
    arrivals.look(received_, steadySeconds());
    if (arrivals.silence() > kStreamsEnded) {
      return {CaptureProgress::State::kRefused,
              std::nullopt,
              "No measurement arrives any more: check the sensor nodes."};
    }
    ros::WallDuration(kCapturePoll).sleep();
  }
}

CaptureProgress MeasurementIntake::capture(Stamp from, double duration) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return builder_.capture(from, duration);
}

std::optional<Stamp> MeasurementIntake::newest() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return builder_.newest();
}

Eigen::VectorXd MeasurementIntake::currents() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return steadySeconds() - currents_arrived_ <= kLatest ? newest_currents_ : Eigen::VectorXd();
}

MotionRecording MeasurementIntake::motion() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return motion_.recording();
}

void MeasurementIntake::forgetMotion() {
  const std::lock_guard<std::mutex> lock(mutex_);
  motion_.forget();
  slicer_.forget();
}

void MeasurementIntake::restoreMotion(const std::vector<MotionSlice>& windows) {
  const std::lock_guard<std::mutex> lock(mutex_);
  motion_.restore(windows);
}

std::vector<MotionSlice> MeasurementIntake::takeWindows() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<MotionSlice> windows;
  while (auto window = slicer_.take()) {
    windows.push_back(std::move(*window));
  }
  return windows;
}

void MeasurementIntake::addDiagnostics(NodeDiagnostics& diagnostics) {
  if (has_joints_) {
    diagnostics.add(joints_);
  }
  for (StreamMonitor* monitor : {&orientations_, &torques_, &currents_}) {
    diagnostics.add(*monitor);
  }
  diagnostics.add("dwells", [this](DiagnosticStatus& status) { diagnoseDwells(status); });
}

void MeasurementIntake::merge(AnyMeasurement measurement) {
  const std::lock_guard<std::mutex> lock(mutex_);
  merger_.add(std::move(measurement), steadySeconds());
  buildInOrder();
}

void MeasurementIntake::buildInOrder() {
  const double now = steadySeconds();
  while (const auto measurement = merger_.next(now)) {
    build(*measurement);
  }
}

void MeasurementIntake::build(const AnyMeasurement& measurement) {
  const SampleBuilderReport& report = builder_.report();
  if (const auto* joints = std::get_if<JointMeasurement>(&measurement)) {
    follow(*joints);
    build(*joints, report.joints, joints_);
  } else if (const auto* orientation = std::get_if<OrientationMeasurement>(&measurement)) {
    follow(*orientation);
    build(*orientation, report.orientations, orientations_);
  } else if (const auto* torque = std::get_if<TorqueMeasurement>(&measurement)) {
    build(*torque, report.torques, torques_);
  } else if (const auto* current = std::get_if<CurrentMeasurement>(&measurement)) {
    follow(*current);
    keepNewest(current->current);
    build(*current, report.currents, currents_);
  }
}

// Motions are told by the readings of joints.
template <typename Measurement>
void MeasurementIntake::follow(const Measurement& measurement) {
  if (has_joints_) {
    motion_.add(measurement);
    slicer_.add(measurement);
  }
}

template <typename Measurement>
void MeasurementIntake::build(const Measurement& measurement,
                              const StreamStatistics& statistics,
                              StreamMonitor& monitor) {
  const std::array<std::uint64_t, kDropReasons> dropped_before = statistics.dropped;
  builder_.add(measurement);
  const std::array<std::uint64_t, kDropReasons>& dropped = statistics.dropped;
  for (std::size_t k = 0; k < kDropReasons; ++k) {
    if (dropped[k] != dropped_before[k]) {
      monitor.refuse(std::string("it is ") + describe(static_cast<DropReason>(k)));
      return;
    }
  }
  monitor.accept(stampToRos(measurement.stamp));
}

bool MeasurementIntake::isOfCoils(const Eigen::VectorXd& currents) const {
  return currents.size() == static_cast<Eigen::Index>(coils_) && currents.allFinite();
}

void MeasurementIntake::keepNewest(const Eigen::VectorXd& currents) {
  if (isOfCoils(currents)) {
    newest_currents_ = currents;
    currents_arrived_ = steadySeconds();
  }
}

bool MeasurementIntake::checkCoils(msg::CheckCoils::Request& request,
                                   msg::CheckCoils::Response& response) {
  try {
    Eigen::VectorXd commanded = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils_));
    for (const SignedCoil& coil : patternFromRos(request.coils, coils_)) {
      requireInRange("current", request.current, ValueRange::positive("A"));
      commanded[static_cast<Eigen::Index>(coil.coil)] = coil.sign * request.current;
    }
    const Eigen::VectorXd measured = currents();
    if (measured.size() == 0) {
      throw DataError("No currents are measured: check the coil driver.");
    }
    response.success = 1;
    response.measured.assign(measured.data(), measured.data() + measured.size());
    const std::optional<std::size_t> coil = coilAmiss(commanded, measured, current_threshold_);
    response.carried = coil ? 0 : 1;
    if (coil) {
      const auto j = static_cast<Eigen::Index>(*coil);
      response.message = format(
          "Coil %zu carries %.4g A where %.4g A are commanded: check the "
          "amplifier and the coil driver.",
          static_cast<std::size_t>(numberOf(*coil)),
          measured[j],
          commanded[j]);
    }
  } catch (const std::exception& error) {
    response.message = printable(error.what());
  }
  return true;
}

void MeasurementIntake::diagnoseDwells(DiagnosticStatus& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const SampleBuilderReport& report = builder_.report();
  status.summary(DiagnosticStatus::OK, "good");
  status.add("dwells seen", report.dwells);
  status.add("samples made", report.samples);
  status.add("discarded", report.discarded);
  for (auto event = report.events.rbegin(); event != report.events.rend(); ++event) {
    if (event->kind == DwellEvent::Kind::kDiscarded) {
      status.add("last discarded", event->reason);
      break;
    }
  }
}

}  // namespace sac
