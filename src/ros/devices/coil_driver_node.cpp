#include "spherical_actuator_calibration/ros/devices/coil_driver_node.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include <ros/console.h>
#include <ros/init.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"

namespace sac {
namespace {

constexpr double kWarningPeriod = 2.0;  // [s]

const Actuator& withCoils(const Actuator& actuator) {
  if (actuator.coils.empty()) {
    throw ConfigError("The description of " + actuator.name + " has no coils to drive.");
  }
  return actuator;
}

}  // namespace

CurrentAmplifierOptions loadCurrentAmplifierOptions(const ros::NodeHandle& private_node) {
  const YamlMap map = privateParameters(private_node);
  CurrentAmplifierOptions options = readCurrentAmplifierOptions(map);
  acceptDiagnosticPeriod(map);
  map.finish();
  return options;
}

CoilDriverNode::CoilDriverNode(const ros::NodeHandle& node,
                               const ros::NodeHandle& private_node,
                               const Actuator& actuator,
                               const CurrentAmplifierOptions& options,
                               std::unique_ptr<ModbusTransport> transport)
    : watchdog_(options.watchdog),
      transport_(std::move(transport)),
      driver_(options, withCoils(actuator).coils.size(), *transport_),
      zero_reason_("no command has come"),
      setpoints_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(actuator.coils.size()))),
      commands_("coil_command", {0.0, options.watchdog}),
      currents_("coil_currents", limitsOfRate(options.rate)),
      link_diagnostics_(describe(options.link)),
      diagnostics_(node, private_node, actuator) {
  ros::NodeHandle handle = node;
  constexpr std::uint32_t kQueueLength = 1000;
  publisher_ = handle.advertise<msg::CoilCurrents>("coil_currents", kQueueLength);
  diagnostics_.add(link_diagnostics_);
  diagnostics_.add("output", [this](DiagnosticStatus& status) { diagnoseOutput(status); });
  diagnostics_.add(currents_);
  // Only the newest command counts.
  subscriber_ = handle.subscribe(
      "coil_command", 1, &CoilDriverNode::receive, this, ros::TransportHints().tcpNoDelay());
  thread_ = std::make_unique<PeriodicThread>(options.rate, [this] { beat(); });
}

CoilDriverNode::~CoilDriverNode() {
  subscriber_.shutdown();
  thread_->stop();
  const std::string failure = driver_.stop();
  if (!failure.empty()) {
    ROS_FATAL_STREAM("The currents could not be set to zero: " << failure
                                                               << " Switch the amplifier off.");
  }
}

void CoilDriverNode::receive(const msg::CoilCurrents::ConstPtr& message) {
  const ros::Time& stamp = message->header.stamp;
  const double age = stamp.isZero() ? 0.0 : (ros::Time::now() - stamp).toSec();
  CurrentMeasurement command;
  currentFromRos(*message, command);
  std::string refusal = commandDefect(command.current, static_cast<std::size_t>(setpoints_.size()));
  if (refusal.empty() && age > watchdog_) {
    refusal = "The command is " + std::to_string(age) + " s old.";
  }
  if (!refusal.empty()) {
    commands_.refuse(refusal);
    ROS_ERROR_STREAM_THROTTLE(kWarningPeriod, "coil_command is refused: " << refusal);
    return;
  }
  commands_.accept(ros::Time::now());
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_command_ = command.current;
  waiting_since_ = steadySeconds();
}

// The devices are slow: the lock is not held while they answer, so that commands never wait.
void CoilDriverNode::beat() {
  try {
    Eigen::VectorXd command;
    double commanded_at = 0.0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      command.swap(waiting_command_);
      commanded_at = waiting_since_;
    }
    if (command.size() > 0) {
      driver_.command(command, commanded_at);
    }
    const ros::Time before = ros::Time::now();
    const CoilDriver::Beat beat = driver_.beat(steadySeconds());
    const ros::Time after = ros::Time::now();
    if (beat.measured) {
      publish(*beat.measured, before + (after - before) * 0.5);
    }
    link_diagnostics_.update(driver_.link());
    const std::lock_guard<std::mutex> lock(mutex_);
    if (beat.zero_reason != zero_reason_) {
      const std::string state = beat.zero_reason.empty()
                                    ? "The coils follow the commands."
                                    : "The currents are zero: " + beat.zero_reason;
      ROS_INFO_STREAM(state);
      diagnostics_.tellAtOnce();
    }
    zero_reason_ = beat.zero_reason;
    fault_ = beat.fault;
    setpoints_ = driver_.limiter().setpoints();
    clamped_ = driver_.limiter().clamped();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM("The control loop failed; the node ends: " << error.what());
    driver_.stop();
    ros::requestShutdown();
  }
}

void CoilDriverNode::publish(const Eigen::VectorXd& currents, const ros::Time& stamp) {
  msg::CoilCurrents message;
  message.header.stamp = stamp;
  message.current.assign(currents.begin(), currents.end());
  publisher_.publish(message);
  currents_.accept(stamp);
}

void CoilDriverNode::diagnoseOutput(DiagnosticStatus& status) {
  // Rate, age and refusals of the commands; that none come is a state, no error.
  commands_.run(status);
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool is_refusing = status.level == DiagnosticStatus::WARN;
  if (!is_refusing) {
    status.summary(
        fault_ ? DiagnosticStatus::ERROR : DiagnosticStatus::OK,
        zero_reason_.empty() ? "commands are followed" : "currents are zero: " + zero_reason_);
  }
  status.add("largest setpoint [A]", setpoints_.cwiseAbs().maxCoeff());
  status.add("sum of setpoints [A]", setpoints_.cwiseAbs().sum());
  status.add("commands clamped", clamped_);
}

}  // namespace sac
