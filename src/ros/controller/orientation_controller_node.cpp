#include "spherical_actuator_calibration/ros/controller/orientation_controller_node.hpp"

#include <exception>

#include <ros/console.h>
#include <ros/init.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/node/wall_stamp.hpp"

namespace sac {
namespace {

constexpr double kWarningPeriod = 2.0;  // [s]
constexpr std::uint32_t kQueueLength = 100;
constexpr double kStatusPeriod = 0.1;  // [s]
/// Of looks whether readings still come: few milliseconds beside the age that is allowed [Hz].
constexpr double kWatchRate = 200.0;
/// Between two commands [s].
constexpr double kLeastPeriod = 2e-4;

}  // namespace

OrientationControllerNode::OrientationControllerNode(
    const ros::NodeHandle& node,
    const ros::NodeHandle& private_node,
    const Actuator& design,
    const OrientationControllerNodeOptions& options)
    : design_(design),
      options_(options),
      reader_(design, {options.stator_frame, {}}),
      target_reader_(jointNames(design)),
      controller_(design, options.controller),
      diagnostics_(node, private_node, design),
      control_(1, &reading_queue_) {
  ros::NodeHandle handle = node;
  ros::NodeHandle private_handle = private_node;
  advertise(handle, private_handle);
  subscribe(handle);
  diagnostics_.add("control", [this](DiagnosticStatus& status) { diagnose(status); });
  handle.setCallbackQueue(&reading_queue_);
  if (design.has_joints) {
    followReadings<sensor_msgs::JointState>(handle, "joint_states");
  } else {
    followReadings<geometry_msgs::QuaternionStamped>(handle, "measured_orientation");
  }
  followCurrents(handle);
  control_.start();
  watch_ = std::make_unique<PeriodicThread>(kWatchRate, [this] { watch(); });
}

OrientationControllerNode::~OrientationControllerNode() {
  watch_->stop();
  control_.stop();
  controller_.disable();
  commandEnd();
}

void OrientationControllerNode::advertise(ros::NodeHandle& handle,
                                          ros::NodeHandle& private_handle) {
  publisher_ = handle.advertise<msg::CoilCurrents>("coil_command", 1);
  parameters_publisher_ =
      private_handle.advertise<msg::ActuatorParameters>("parameters_in_force", 1, true);
  motion_publisher_ = private_handle.advertise<msg::MotionStatus>("motion_status", 10, true);
  services_ = {
      private_handle.advertiseService("enable", &OrientationControllerNode::enable, this),
      private_handle.advertiseService(
          "follow_motion", &OrientationControllerNode::followMotion, this),
      private_handle.advertiseService("end_motion", &OrientationControllerNode::endMotion, this)};
  motion_timer_ = private_handle.createWallTimer(ros::WallDuration(kStatusPeriod),
                                                 [this](const ros::WallTimerEvent& /*event*/) {
                                                   tellParameters();
                                                   tellMotion();
                                                 });
}

void OrientationControllerNode::subscribe(ros::NodeHandle& handle) {
  const ros::TransportHints at_once = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(subscribeChecked<msg::ActuatorParameters>(
      handle,
      "parameters",
      1,
      [this](const msg::ActuatorParameters::ConstPtr& message) { receiveParameters(*message); },
      tellRefusal("parameters")));
  subscribers_.push_back(subscribeChecked<geometry_msgs::QuaternionStamped>(
      handle,
      "orientation_target",
      kQueueLength,
      [this](const geometry_msgs::QuaternionStamped::ConstPtr& message) {
        receiveTarget(*message);
      },
      tellRefusal("orientation_target"),
      at_once));
  if (design_.has_joints) {
    subscribers_.push_back(subscribeChecked<sensor_msgs::JointState>(
        handle,
        "joint_target",
        kQueueLength,
        [this](const sensor_msgs::JointState::ConstPtr& message) { receiveJointTarget(*message); },
        tellRefusal("joint_target"),
        at_once));
  }
}

void OrientationControllerNode::receiveParameters(const msg::ActuatorParameters& message) {
  // Before the control loop has to wait: a large map takes its time.
  const std::optional<Actuator> parameters = actuatorFromRos(message, design_);
  if (!parameters) {
    ROS_ERROR_STREAM("The parameters of " << printable(message.actuator)
                                          << " do not fit the description of " << design_.name
                                          << "; those before stay in force.");
    return;
  }
  try {
    const std::lock_guard<std::mutex> lock(mutex_);
    controller_.setParameters(*parameters);
    parameters_to_tell_ = message;
  } catch (const Error& error) {
    ROS_ERROR_STREAM("The parameters are refused: " << printable(error.what()));
  }
  tellParameters();
}

void OrientationControllerNode::tellParameters() {
  std::optional<msg::ActuatorParameters> message;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (controller_.hasParametersToCome()) {
      return;
    }
    message.swap(parameters_to_tell_);
  }
  if (message) {
    parameters_publisher_.publish(*message);
    ROS_INFO_STREAM("Revision " << message->revision << " of the parameters ("
                                << printable(message->source) << ") is in force.");
  }
}

// Of readings that wait, the newest alone is of use.
template <typename Message>
void OrientationControllerNode::followReadings(ros::NodeHandle& handle, const std::string& topic) {
  reading_subscriber_ = subscribeChecked<Message>(
      handle,
      topic,
      1,
      [this, topic](const typename Message::ConstPtr& message) { receive(*message, topic); },
      tellRefusal(topic),
      ros::TransportHints().tcpNoDelay());
}

template <typename Message>
void OrientationControllerNode::receive(const Message& message, const std::string& topic) {
  const auto* const reading = reader_.read(message);
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    if (reading == nullptr) {
      throw DataError(reader_.refusal() + ".");
    }
    if (!controller_.receive(*reading)) {
      return;
    }
  } catch (const Error& error) {
    last_refusal_ = topic + ": " + printable(error.what());
    ROS_ERROR_STREAM_THROTTLE(kWarningPeriod, last_refusal_);
    return;
  }
  const double interval = last_stamp_ == 0 ? 0.0 : secondsBetween(last_stamp_, reading->stamp);
  last_stamp_ = reading->stamp;
  last_reading_ = steadySeconds();
  try {
    command(interval);
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void OrientationControllerNode::followCurrents(ros::NodeHandle& handle) {
  const std::string topic = "coil_currents";
  current_subscriber_ = subscribeChecked<msg::CoilCurrents>(
      handle,
      topic,
      1,
      [this](const msg::CoilCurrents::ConstPtr& message) {
        const CurrentMeasurement* currents = reader_.read(*message);
        const std::lock_guard<std::mutex> lock(mutex_);
        controller_.receiveCurrents(*currents);
      },
      tellRefusal(topic),
      ros::TransportHints().tcpNoDelay());
}

void OrientationControllerNode::receiveTarget(const geometry_msgs::QuaternionStamped& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    if (!isFrame(message.header.frame_id, options_.stator_frame)) {
      throw DataError("it " + otherFrame(message.header.frame_id, options_.stator_frame) + ".");
    }
    const OrientationMeasurement target = orientationFromRos(message);
    if (!isUnit(target.q_stator_rotor)) {
      throw DataError("its quaternion is not of unit length.");
    }
    const Stamp stamp =
        message.header.stamp.isZero() ? stampFromRos(ros::Time::now()) : target.stamp;
    controller_.setTarget(stamp, target.q_stator_rotor.normalized().toRotationMatrix());
  } catch (const Error& error) {
    refuseTarget("orientation_target", error);
  }
}

// The orientation is that of the moment: parameters that come later do not move the target.
void OrientationControllerNode::receiveJointTarget(const sensor_msgs::JointState& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    const std::optional<JointMeasurement> target = target_reader_.read(message);
    if (!target) {
      throw DataError("a joint is missing.");
    }
    const Stamp stamp =
        message.header.stamp.isZero() ? stampFromRos(ros::Time::now()) : target->stamp;
    controller_.setTarget(stamp, controller_.orientationAt(target->position));
  } catch (const Error& error) {
    refuseTarget("joint_target", error);
  }
}

void OrientationControllerNode::refuseTarget(const std::string& topic, const Error& reason) {
  last_refusal_ = topic + ": " + printable(reason.what());
  ROS_WARN_STREAM_THROTTLE(kWarningPeriod, last_refusal_);
}

bool OrientationControllerNode::enable(std_srvs::SetBool::Request& request,
                                       std_srvs::SetBool::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    if (request.data != 0) {
      controller_.enable(stampFromRos(ros::Time::now()));
      // So that a stop in the very first cycle is told as well.
      was_active_ = true;
      response.message = "The coils hold the rotor, and turn it to its targets.";
    } else {
      controller_.disable();
      commandEnd();
      response.message = "The coils have no current.";
    }
    response.success = 1;
  } catch (const Error& error) {
    response.success = 0;
    response.message = std::string("Not enabled: ") + error.what() + ".";
  }
  return true;
}

void OrientationControllerNode::command(double reading_interval) {
  if (controller_.state() != ControlState::kActive) {
    return;
  }
  LoopTurn time;
  time.begin = steadySeconds();
  // A flood of readings must not become one of commands.
  if (time.begin - last_command_ < kLeastPeriod) {
    return;
  }
  last_command_ = time.begin;
  const Stamp now = stampFromRos(ros::Time::now());
  const Eigen::VectorXd& currents = controller_.update(now);
  if (controller_.state() == ControlState::kActive) {
    publish(currents);
    time.end = steadySeconds();
    time.age = secondsBetween(last_stamp_, now);
    time.interval = reading_interval;
    timing_.add(time);
  }
  commandEnd();
}

// The clock of ROS may stand still: a paused replay must not keep the currents on.
void OrientationControllerNode::watch() {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    if (steadySeconds() - last_reading_ > options_.controller.largest_age) {
      controller_.stop(std::string("no ") + controller_.readings() + " arrive");
    }
    commandEnd();
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void OrientationControllerNode::commandEnd() {
  if (!was_active_ || controller_.state() == ControlState::kActive) {
    return;
  }
  was_active_ = false;
  timing_.interrupt();
  publish(controller_.update(0));
  if (controller_.state() == ControlState::kStopped) {
    ROS_ERROR_STREAM("The control has stopped, the currents are zero: "
                     << controller_.stopReason() << ". Call enable to go on.");
  }
}

void OrientationControllerNode::fail(const std::string& reason) {
  ROS_FATAL_STREAM("The control failed; the node ends: " << reason);
  controller_.disable();
  commandEnd();
  ros::requestShutdown();
}

// The coil driver judges commands by the wall clock alone.
void OrientationControllerNode::publish(const Eigen::VectorXd& currents) {
  message_.header.stamp = wallStamp();
  message_.current.assign(currents.begin(), currents.end());
  publisher_.publish(message_);
}

void OrientationControllerNode::diagnose(DiagnosticStatus& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  switch (controller_.state()) {
    case ControlState::kIdle:
      status.summary(DiagnosticStatus::OK, "not enabled");
      break;
    case ControlState::kActive:
      status.summary(DiagnosticStatus::OK, "follows its targets");
      if (const TorqueCut cut = controller_.takeTorqueCut(); cut.share < 1.0) {
        status.summary(DiagnosticStatus::WARN, inWords(cut));
      }
      break;
    case ControlState::kStopped:
      status.summary(DiagnosticStatus::ERROR, "stopped: " + controller_.stopReason());
      break;
  }
  diagnoseTiming(status);
  status.add("motion", motionPhaseName(told_phase_));
  status.add("tracking error [mrad]", 1e3 * controller_.trackingError());
  status.add("load made up for [mN m]", 1e3 * controller_.disturbance().norm());
  addTextOrNone(status, "last refusal", last_refusal_);
}

void OrientationControllerNode::diagnoseTiming(DiagnosticStatus& status) {
  const TimingReport report = timing_.take();
  status.add("commands", report.turns);
  addTiming(status, report, "reading", "computation");
  status.add("commands since start", timing_.turns());
  status.add("of them on an old reading", timing_.oldTurns());
}

}  // namespace sac
