#include "spherical_actuator_calibration/ros/devices/coil_driver_node.hpp"

#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include <ros/console.h>
#include <ros/init.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"
#include "spherical_actuator_calibration/ros/node/wall_stamp.hpp"

namespace sac {
namespace {

constexpr double kWarningPeriod = 2.0;  // [s]
/// For currents to fade, and for an amplifier that does not answer at once, when the node ends [s].
constexpr double kStopTime = 1.0;
/// The main thread, which takes leave, may be stuck: then the loop ends the program [s].
constexpr unsigned kLastResort = 5;
/// Between two looks whether the currents have faded.
constexpr std::chrono::milliseconds kStopPause{5};
/// The commands of all callers that come while one is judged: none may push out another's.
constexpr std::uint32_t kWaitingCommands = 100;

constexpr char kUnattended[] =
    "it has no heartbeat, so that nothing ends its currents when this program is killed.";

Instant instantNow() {
  return {steadySeconds(), wallStamp().toSec()};
}

CoilCommand commandFromRos(const msg::CoilCurrents& message, const MessageSender& sender) {
  CoilCommand command;
  command.caller = sender.name;
  command.connection = sender.connection;
  if (!message.header.stamp.isZero()) {
    command.stamp = message.header.stamp.toSec();
  }
  command.currents = Eigen::Map<const Eigen::VectorXd>(
      message.current.data(), static_cast<Eigen::Index>(message.current.size()));
  return command;
}

msg::CoilCurrents currentsToRos(const Eigen::VectorXd& currents, const ros::Time& stamp) {
  msg::CoilCurrents message;
  message.header.stamp = stamp;
  message.current.assign(currents.begin(), currents.end());
  return message;
}

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
    : is_unattended_(!options.heartbeat_address),
      rate_(options.rate),
      amplifier_(std::make_shared<DrivenAmplifier>(
          options, withCoils(actuator).coils.size(), std::move(transport))),
      driver_(amplifier_->driver),
      zero_reason_("no command has come"),
      setpoints_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(actuator.coils.size()))),
      commands_("coil_command", {0.0, options.supervision.watchdog}),
      currents_("coil_currents", limitsOfRate(options.rate)),
      timing_("beats", "command", "exchange"),
      link_diagnostics_(describe(options.link)),
      diagnostics_(node, private_node, actuator),
      receiver_(1, &queue_) {
  ros::NodeHandle handle = node;
  constexpr std::uint32_t kQueueLength = 10000;
  publisher_ = handle.advertise<msg::CoilCurrents>("coil_currents", kQueueLength);
  setpoints_publisher_ = handle.advertise<msg::CoilCurrents>("coil_setpoints", kQueueLength);
  diagnostics_.add(link_diagnostics_);
  diagnostics_.add("output", [this](DiagnosticStatus& status) { diagnoseOutput(status); });
  diagnostics_.add(currents_);
  diagnostics_.add(timing_);
  if (is_unattended_) {
    ROS_WARN_STREAM("The amplifier is unattended: " << kUnattended);
  }
  if (ros::Time::isSimTime()) {
    ROS_WARN("/use_sim_time is set: commands are judged by the wall clock all the same.");
  }
  handle.setCallbackQueue(&queue_);
  subscriber_ = subscribeChecked<msg::CoilCurrents>(
      handle,
      "coil_command",
      kWaitingCommands,
      [this](const msg::CoilCurrents::ConstPtr& message, const MessageSender& sender) {
        receive(*message, sender);
      },
      [this](const std::string& reason) { commands_.refuse(reason); },
      ros::TransportHints().tcpNoDelay());
  thread_ = std::make_unique<PeriodicThread>(options.rate, [this] { beat(); });
  // Whoever is heard may wake the thread.
  receiver_.start();
}

// First the currents, then the rest: to end a subscription, a master is asked that may be gone, or
// never answer.
CoilDriverNode::~CoilDriverNode() {
  stop();
  subscriber_.shutdown();
}

bool CoilDriverNode::stop() {
  if (stopped_) {
    return !failed_ && endedWell();
  }
  stopped_ = true;
  thread_->stop();
  const double end = steadySeconds() + kStopTime;
  std::string failure = tryToStop();
  while (!failure.empty() && steadySeconds() < end) {
    std::this_thread::sleep_for(kStopPause);
    failure = tryToStop();
  }
  receiver_.stop();
  const CurrentSupervisor& supervisor = driver_.supervisor();
  if (!supervisor.fault().empty()) {
    ROS_FATAL_STREAM("The driver ends in an error: " << supervisor.fault() << '.');
  }
  if (failure.empty()) {
    return !failed_ && endedWell();
  }
  if (supervisor.isZeroConfirmed()) {
    ROS_WARN_STREAM(
        "The amplifier cannot be told once more that its currents are zero, as they "
        "were when it was heard last: "
        << failure);
    return !failed_ && endedWell();
  }
  ROS_FATAL_STREAM("The currents are not confirmed to be zero, " << supervisor.unconfirmedReason()
                                                                 << ": " << failure
                                                                 << " Switch the amplifier off.");
  return false;
}

std::unique_ptr<ZeroWatch> CoilDriverNode::watch() const {
  return std::make_unique<ZeroWatch>(amplifier_, rate_);
}

// An amplifier that does not do what it acknowledges may have current again at any time.
bool CoilDriverNode::endedWell() const {
  const CurrentSupervisor& supervisor = driver_.supervisor();
  return supervisor.isZeroConfirmed() && supervisor.fault().empty();
}

std::string CoilDriverNode::tryToStop() {
  try {
    return driver_.stop(steadySeconds());
  } catch (const std::exception& error) {
    return error.what();
  }
}

void CoilDriverNode::receive(const msg::CoilCurrents& message, const MessageSender& sender) {
  const std::string refusal = driver_.offer(commandFromRos(message, sender), instantNow());
  if (!refusal.empty()) {
    commands_.refuse(refusal);
    ROS_ERROR_STREAM_THROTTLE(kWarningPeriod, "coil_command is refused: " << printable(refusal));
    return;
  }
  thread_->wake();
  commands_.accept(ros::Time::now());
}

// The devices are slow: no lock is held while they answer, so that commands never wait.
void CoilDriverNode::beat() {
  try {
    if (terminationRequested()) {
      // At once, whatever the main thread is busy with, and for however long.
      if (!is_leaving_) {
        is_leaving_ = true;
        endWithin(kLastResort, 1);
      }
      driver_.stop(steadySeconds());
      return;
    }
    const double begin = steadySeconds();
    const CoilDriver::Beat beat = driver_.beat(begin);
    const double end = steadySeconds();
    // What the beat did since then must not make a stamp late.
    if (beat.set_at && setpoints_publisher_.getNumSubscribers() > 0) {
      setpoints_publisher_.publish(
          currentsToRos(driver_.limiter().setpoints(),
                        timeBefore(ros::Time::now(), steadySeconds() - *beat.set_at)));
    }
    if (beat.measured) {
      publish(*beat.measured, timeBefore(ros::Time::now(), steadySeconds() - beat.measured_at));
      timing_.add({begin, end, beat.command_age});
    } else {
      timing_.interrupt();
    }
    tell(beat);
  } catch (const std::exception& error) {
    failed_ = true;
    const std::string failure = tryToStop();
    ROS_FATAL_STREAM("The control loop failed; the node ends: " << error.what() << " " << failure);
    ros::requestShutdown();
  }
}

void CoilDriverNode::tell(const CoilDriver::Beat& beat) {
  link_diagnostics_.update(driver_.link());
  const std::lock_guard<std::mutex> lock(mutex_);
  if (beat.zero_reason != zero_reason_) {
    diagnostics_.tellAtOnce();
    if (beat.zero_reason.empty()) {
      ROS_INFO("The coils follow the commands.");
    } else if (beat.fault) {
      ROS_ERROR_STREAM("The currents are set to zero: " << beat.zero_reason);
    } else {
      ROS_INFO_STREAM("The currents are set to zero: " << beat.zero_reason);
    }
  }
  zero_reason_ = beat.zero_reason;
  fault_ = beat.fault;
  setpoints_ = driver_.limiter().setpoints();
  clamped_ = driver_.limiter().clamped();
}

void CoilDriverNode::publish(const Eigen::VectorXd& currents, const ros::Time& stamp) {
  publisher_.publish(currentsToRos(currents, stamp));
  currents_.accept(stamp);
}

void CoilDriverNode::diagnoseOutput(DiagnosticStatus& status) {
  // Rate, age and refusals of the commands; that none come is a state, no error.
  commands_.run(status);
  const bool is_refusing = status.level == DiagnosticStatus::WARN;
  const CurrentSupervisor& supervisor = driver_.supervisor();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!is_refusing || fault_) {
    const char* state = supervisor.isZeroConfirmed() ? "currents are zero: "
                                                     : "zero is set, but was not measured yet: ";
    status.summary(fault_ ? DiagnosticStatus::ERROR : DiagnosticStatus::OK,
                   zero_reason_.empty() ? "commands are followed" : state + zero_reason_);
  }
  if (is_unattended_) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        std::string("unattended amplifier: ") + kUnattended);
  }
  if (clamped_ > told_clamped_) {
    told_clamped_ = clamped_;
    status.mergeSummary(DiagnosticStatus::WARN,
                        "commands are beyond the limits of this driver (" +
                            driver_.limiter().limitsInWords() + ") and are clamped: ask for less");
  }
  addTextOrNone(status, "commander", supervisor.owner(steadySeconds()));
  status.add("zero measured", supervisor.isZeroConfirmed() ? "yes" : "no");
  status.add("largest setpoint [A]", setpoints_.cwiseAbs().maxCoeff());
  status.add("sum of setpoints [A]", setpoints_.cwiseAbs().sum());
  status.add("commands clamped", clamped_);
  status.add("deviations", supervisor.faults());
}

}  // namespace sac
