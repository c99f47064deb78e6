#include "spherical_actuator_calibration/ros/emulation_node/lab_emulator_node.hpp"

#include <algorithm>
#include <cmath>

#include <ros/console.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

namespace sac {
namespace {

/// Who listens and has to wait for the processor misses nothing for seconds, as with the drivers.
constexpr std::uint32_t kQueueLength = 10000;
/// A computer that was busy must not make the fixture jump [s].
constexpr double kLongestBeat = 0.05;
constexpr double kWarningPeriod = 2.0;  // [s]
/// Requests that follow each other within this time are of one reading [s].
constexpr double kOneReading = 3e-4;

ScheduledMeasurement scheduled(bool glitch) {
  ScheduledMeasurement measurement;
  measurement.glitch = glitch;
  return measurement;
}

}  // namespace

LabEmulatorNode::LabEmulatorNode(const ros::NodeHandle& node,
                                 const ros::NodeHandle& private_node,
                                 const Actuator& nominal,
                                 const LabEmulatorOptions& options)
    : options_(options),
      truth_(manufacturedActuator(nominal, options.errors, options.seed)),
      actuator_(truth_, options.load),
      joint_server_(nominal.has_joints
                        ? std::make_unique<ModbusServer>(options.joint_sensor.link.host,
                                                         options.joint_sensor.link.port)
                        : nullptr),
      amplifier_server_(options.coil_driver.link.host, options.coil_driver.link.port),
      fixture_(options.fixture, Eigen::Vector3d::Zero()),
      amplifier_(options.coil_driver, options.amplifier, truth_.coils.size(), amplifier_server_),
      joints_(options.joints, options.seed),
      tracker_(options.tracker, options.registration, 0, options.seed),
      ft_sensor_(options.ft_sensor, options.registration, options.seed),
      current_sensor_(options.currents, options.seed),
      history_(longestDelay(options.delays)),
      now_(steadySeconds()),
      pose_due_(now_),
      node_(node),
      private_node_(private_node) {
  if (!options_.truth.empty()) {
    saveDescription(options_.truth, {truth_}, OverwritePolicy::kReplace);
  }
  pose_message_.header.frame_id = options_.tracker_frame;
  wrench_message_.header.frame_id = options_.ft_sensor_frame;
  pose_publisher_ = node_.advertise<geometry_msgs::PoseStamped>("tracker/pose", kQueueLength);
  true_message_.header.frame_id = options_.stator_frame;
  true_publisher_ =
      private_node_.advertise<geometry_msgs::QuaternionStamped>("true_orientation", kQueueLength);
  if (actuator_.hasTorque()) {
    wrench_publisher_ =
        node_.advertise<geometry_msgs::WrenchStamped>("ft_sensor/wrench", kQueueLength);
    free_rotor_.emplace(truth_,
                        RigidRotor{options_.inertia, options_.load.unbalance},
                        options_.mechanical_stop,
                        options_.friction);
    services_.push_back(
        private_node_.advertiseService("release_fixture", &LabEmulatorNode::releaseFixture, this));
    services_.push_back(private_node_.advertiseService("push", &LabEmulatorNode::push, this));
  }
  history_.add(now_, {position(), amplifier_.currents()});
  if (joint_server_) {
    startJointSensor();
    followTargets<sensor_msgs::JointState>("fixture/target");
  } else {
    followTargets<geometry_msgs::QuaternionStamped>("fixture/orientation_target");
  }
  amplifier_server_.beforeRequest([this] { answerAmplifier(); });
  advertiseFaults();
  thread_ = std::make_unique<PeriodicThread>(options_.ft_sensor.stream.rate, [this] { beat(); });
}

LabEmulatorNode::~LabEmulatorNode() {
  // The servers end later than what answers them.
  if (joint_server_) {
    joint_server_->beforeRequest({});
  }
  amplifier_server_.beforeRequest({});
}

void LabEmulatorNode::startJointSensor() {
  for (const RegisterContent& content : encodeJoints(options_.joint_sensor, position())) {
    joint_server_->addUnit(content.unit);
  }
  showJoints();
  joint_server_->beforeRequest([this] { answerJointSensor(); });
}

void LabEmulatorNode::advertiseFaults() {
  advertiseFault("lose_tracker", tracker_lost_, "The tracker has lost its marker.");
  if (joint_server_) {
    advertiseFault("freeze_sensor", sensor_frozen_, "The joint sensors' registers stand still.");
  }
  advertiseFault("trip_amplifier", amplifier_tripped_, "The amplifier has tripped.");
  services_.push_back(private_node_.advertiseService<Trigger::Request, Trigger::Response>(
      "inject_outlier", [this](Trigger::Request& /*request*/, Trigger::Response& response) {
        const std::lock_guard<std::mutex> lock(mutex_);
        outlier_pose_ = true;
        outlier_wrench_ = true;
        response.success = 1;
        response.message = "The next tracker pose and the next wrench are far off.";
        return true;
      }));
}

void LabEmulatorNode::advertiseFault(const char* name, bool& flag, const char* what) {
  services_.push_back(private_node_.advertiseService<SetBool::Request, SetBool::Response>(
      name, [this, &flag, what](SetBool::Request& request, SetBool::Response& response) {
        const std::lock_guard<std::mutex> lock(mutex_);
        flag = request.data != 0;
        response.success = 1;
        response.message = flag ? what : "It works again.";
        return true;
      }));
}

template <typename Message>
void LabEmulatorNode::followTargets(const std::string& topic) {
  target_subscriber_ = subscribeChecked<Message>(
      node_,
      topic,
      kQueueLength,
      [this, topic](const typename Message::ConstPtr& message) {
        try {
          setTarget(targetOf(*message));
        } catch (const DataError& error) {
          ROS_WARN_STREAM(topic << ": " << printable(error.what()));
        }
      },
      tellRefusal(topic));
}

Eigen::Vector3d LabEmulatorNode::targetOf(const sensor_msgs::JointState& message) const {
  if (message.name.size() != kJoints || message.position.size() != kJoints) {
    throw DataError("a target has a name and a position for each of the three joints.");
  }
  Eigen::Vector3d target;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const std::string& name = truth_.joints[k].name;
    const auto place = std::find(message.name.begin(), message.name.end(), name);
    if (place == message.name.end()) {
      throw DataError("the joint " + name + " is missing.");
    }
    target[static_cast<Eigen::Index>(k)] =
        message.position[static_cast<std::size_t>(place - message.name.begin())];
  }
  return target;
}

Eigen::Vector3d LabEmulatorNode::targetOf(const geometry_msgs::QuaternionStamped& message) const {
  if (!isFrame(message.header.frame_id, options_.stator_frame)) {
    throw DataError("the target " + otherFrame(message.header.frame_id, options_.stator_frame) +
                    ".");
  }
  return freeRotorAngles(quaternionFromRos(message.quaternion));
}

void LabEmulatorNode::setTarget(const Eigen::Vector3d& target) {
  constexpr double kRounding = 1e-6;
  if (!target.allFinite() || !truth_.workspace.contains(target, kRounding)) {
    throw DataError("the target lies outside of the workspace, " +
                    shortNumber(truth_.workspace.tilt_limit) + " rad of tilt either way.");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  // Joints turn to the very angles, an orientation is reached by the shortest turn.
  fixture_.setTarget(truth_.has_joints ? target : nearestTurns(target, fixture_.position()));
}

bool LabEmulatorNode::releaseFixture(SetBool::Request& request, SetBool::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool release = request.data != 0;
  if (release && !released_) {
    free_rotor_->release(fixture_.position());
  } else if (!release && released_) {
    fixture_.hold(free_rotor_->position());
  }
  released_ = release;
  response.success = 1;
  response.message = release ? "The rotor is free: coils and gravity move it."
                             : "The fixture holds the rotor where it was.";
  return true;
}

bool LabEmulatorNode::push(msg::Push::Request& request, msg::Push::Response& response) {
  constexpr double kLongestPush = 10.0;  // [s]
  const Eigen::Vector3d torque(request.torque.x, request.torque.y, request.torque.z);
  const std::lock_guard<std::mutex> lock(mutex_);
  response.success = 0;
  if (!torque.allFinite() || !(request.duration > 0.0 && request.duration <= kLongestPush)) {
    response.message = "A push has a finite torque, and lasts at most 10 s.";
  } else if (!released_) {
    response.message = "The fixture holds the rotor: release it before it can be pushed.";
  } else {
    push_stator_ = torque;
    push_end_ = now_ + request.duration;
    response.success = 1;
    response.message = "The rotor is pushed.";
  }
  return true;
}

void LabEmulatorNode::answerJointSensor() {
  const double now = steadySeconds();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (now - joints_shown_ > kOneReading) {
    advanceTo(now);
    showJoints();
    joints_shown_ = now;
  }
}

// What the amplifier is told counts from now on: until now it was told something else.
void LabEmulatorNode::answerAmplifier() {
  const std::lock_guard<std::mutex> lock(mutex_);
  advanceTo(steadySeconds());
  showCurrents();
}

void LabEmulatorNode::advanceTo(double now) {
  const double step = std::clamp(now - now_, 0.0, kLongestBeat);
  now_ = std::max(now, now_);
  amplifier_.setTripped(amplifier_tripped_);
  moveRotor(step);
  history_.add(now_, {position(), amplifier_.currents()});
}

void LabEmulatorNode::moveRotor(double step) {
  if (!released_) {
    fixture_.advance(step);
    amplifier_.advance(step);
    return;
  }
  // In steps that the integrator is good for, the currents of the middle of each.
  constexpr double kLongestStep = 5e-4;
  const auto steps = std::max(1, static_cast<int>(std::ceil(step / kLongestStep)));
  const Eigen::Vector3d push = now_ < push_end_ ? push_stator_ : Eigen::Vector3d::Zero().eval();
  for (int n = 0; n < steps; ++n) {
    amplifier_.advance(0.5 * step / steps);
    free_rotor_->advance(step / steps, amplifier_.currents(), push);
    amplifier_.advance(0.5 * step / steps);
  }
  if (free_rotor_->isAtStop()) {
    ROS_WARN_THROTTLE(kWarningPeriod, "The rotor is at its mechanical stop.");
  }
}

const Eigen::Vector3d& LabEmulatorNode::position() const {
  return released_ ? free_rotor_->position() : fixture_.position();
}

void LabEmulatorNode::beat() {
  const double now = steadySeconds();
  const std::lock_guard<std::mutex> lock(mutex_);
  advanceTo(now);
  if (actuator_.hasTorque() && !released_) {
    publishWrench();
  }
  if (now >= pose_due_) {
    pose_due_ = std::max(pose_due_ + 1.0 / options_.tracker.stream.rate, now - kLongestBeat);
    publishPose();
    publishTruth();
  }
}

void LabEmulatorNode::showJoints() {
  if (sensor_frozen_) {
    return;
  }
  const LaboratoryMoment seen = history_.at(now_ - options_.delays.joints);
  const JointMeasurement reading = joints_.measure(0, seen.position, {});
  for (const RegisterContent& content : encodeJoints(options_.joint_sensor, reading.position)) {
    joint_server_->setWords(content.unit, content.table, content.address, content.words);
  }
}

void LabEmulatorNode::showCurrents() {
  const LaboratoryMoment seen = history_.at(now_ - options_.delays.currents);
  amplifier_.show(current_sensor_.measure(0, seen.currents, {}).current);
}

// Threads that wait for each other must not make a sensor late.
ros::Time LabEmulatorNode::stampOfState() const {
  return timeBefore(ros::Time::now(), std::max(0.0, steadySeconds() - now_));
}

void LabEmulatorNode::publishPose() {
  if (tracker_lost_) {
    return;
  }
  const LaboratoryMoment seen = history_.at(now_ - options_.delays.tracker);
  const MarkerPoseMeasurement pose = tracker_.measure(
      0, actuator_.orientation(seen.position), std::nullopt, scheduled(outlier_pose_));
  outlier_pose_ = false;
  pose_message_.header.stamp = stampOfState();
  pose_message_.pose.position = pointToRos(pose.position);
  pose_message_.pose.orientation = quaternionToRos(pose.q_tracker_marker);
  pose_publisher_.publish(pose_message_);
}

void LabEmulatorNode::publishTruth() {
  true_message_.header.stamp = stampOfState();
  true_message_.quaternion = quaternionToRos(Eigen::Quaterniond(actuator_.orientation(position())));
  true_publisher_.publish(true_message_);
}

void LabEmulatorNode::publishWrench() {
  const LaboratoryMoment seen = history_.at(now_ - options_.delays.ft_sensor);
  const Eigen::Matrix3d R_stator_rotor = actuator_.orientation(seen.position);
  const WrenchMeasurement wrench =
      ft_sensor_.measure(0,
                         actuator_.torque(R_stator_rotor, seen.currents),
                         actuator_.weight(R_stator_rotor),
                         scheduled(outlier_wrench_));
  outlier_wrench_ = false;
  wrench_message_.header.stamp = stampOfState();
  wrench_message_.wrench.force = vectorToRos(wrench.force);
  wrench_message_.wrench.torque = vectorToRos(wrench.torque);
  wrench_publisher_.publish(wrench_message_);
}

}  // namespace sac
