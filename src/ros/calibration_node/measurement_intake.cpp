#include "spherical_actuator_calibration/ros/calibration_node/measurement_intake.hpp"

#include <array>
#include <utility>

#include <ros/time.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/recording/recorded_streams.hpp"

namespace sac {
namespace {

/// Messages that may wait while the receiving thread is held up: seconds at the highest rates.
constexpr std::uint32_t kQueueLength = 20000;

/// A stream that is absent, such as a tracker which is switched off, is told but is no error of the
/// calibration; what is too old or too slow for a dwell is.
constexpr StreamLimits kLimits = {20.0, 0.5};

double steadySeconds() {
  return ros::SteadyTime::now().toSec();
}

std::string otherFrame(const std::string& frame_id, const std::string& frame) {
  return "it is in the frame \"" + frame_id + "\", not in \"" + frame + "\"";
}

}  // namespace

MeasurementIntake::MeasurementIntake(const ros::NodeHandle& node,
                                     const Actuator& nominal,
                                     const CalibrationConfig& config)
    : frames_(config.frames),
      builder_(config.samples, modelledCoils(nominal)),
      joint_reader_(jointNames(nominal)),
      joints_("joint_states", kLimits),
      orientations_("measured_orientation", kLimits),
      torques_("measured_torque", kLimits),
      currents_("coil_currents", kLimits),
      node_(node),
      receiver_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  const auto subscribe = [&](const char* topic, auto callback) {
    subscribers_.push_back(node_.subscribe(topic, kQueueLength, callback, this, hints));
  };
  using Self = MeasurementIntake;
  subscribe("joint_states",
            static_cast<void (Self::*)(const sensor_msgs::JointState::ConstPtr&)>(&Self::receive));
  subscribe("measured_orientation",
            static_cast<void (Self::*)(const geometry_msgs::QuaternionStamped::ConstPtr&)>(
                &Self::receive));
  subscribe(
      "measured_torque",
      static_cast<void (Self::*)(const geometry_msgs::Vector3Stamped::ConstPtr&)>(&Self::receive));
  subscribe("coil_currents",
            static_cast<void (Self::*)(const msg::CoilCurrents::ConstPtr&)>(&Self::receive));
  receiver_.start();
}

MeasurementIntake::~MeasurementIntake() {
  receiver_.stop();
}

std::vector<Sample> MeasurementIntake::takeSamples() {
  const std::lock_guard<std::mutex> lock(mutex_);
  buildInOrder();
  return builder_.takeSamples();
}

CaptureProgress MeasurementIntake::capture(Stamp from, double duration) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return builder_.capture(from, duration);
}

std::optional<Stamp> MeasurementIntake::newest() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return builder_.newest();
}

void MeasurementIntake::finish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  while (const auto measurement = merger_.nextAtOnce()) {
    build(*measurement);
  }
  builder_.finish();
}

void MeasurementIntake::addDiagnostics(diagnostic_updater::Updater& updater) {
  for (StreamMonitor* monitor : {&joints_, &orientations_, &torques_, &currents_}) {
    updater.add(*monitor);
  }
  updater.add("dwells", this, &MeasurementIntake::diagnoseDwells);
}

void MeasurementIntake::receive(const sensor_msgs::JointState::ConstPtr& message) {
  ++received_;
  if (const auto measurement = joint_reader_.read(*message)) {
    merge(*measurement);
    return;
  }
  joints_.refuse("it lacks a joint of the description, or its position");
}

void MeasurementIntake::receive(const geometry_msgs::QuaternionStamped::ConstPtr& message) {
  ++received_;
  if (!isFrame(message->header.frame_id, frames_.stator)) {
    orientations_.refuse(otherFrame(message->header.frame_id, frames_.stator));
    return;
  }
  merge(orientationFromRos(*message));
}

void MeasurementIntake::receive(const geometry_msgs::Vector3Stamped::ConstPtr& message) {
  ++received_;
  if (!isFrame(message->header.frame_id, frames_.rotor)) {
    torques_.refuse(otherFrame(message->header.frame_id, frames_.rotor));
    return;
  }
  merge(torqueFromRos(*message));
}

void MeasurementIntake::receive(const msg::CoilCurrents::ConstPtr& message) {
  ++received_;
  CurrentMeasurement measurement;
  currentFromRos(*message, measurement);
  merge(std::move(measurement));
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
    build(*joints, report.joints, joints_);
  } else if (const auto* orientation = std::get_if<OrientationMeasurement>(&measurement)) {
    build(*orientation, report.orientations, orientations_);
  } else if (const auto* torque = std::get_if<TorqueMeasurement>(&measurement)) {
    build(*torque, report.torques, torques_);
  } else if (const auto* current = std::get_if<CurrentMeasurement>(&measurement)) {
    build(*current, report.currents, currents_);
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

void MeasurementIntake::diagnoseDwells(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const SampleBuilderReport& report = builder_.report();
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "good");
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
