#include "spherical_actuator_calibration/ros/devices/joint_sensor_node.hpp"

#include <algorithm>
#include <utility>

#include <ros/console.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

namespace sac {
namespace {

constexpr double kSensorWarningPeriod = 5.0;  // [s]

}  // namespace

JointSensorOptions loadJointSensorOptions(const ros::NodeHandle& private_node) {
  const YamlMap map = privateParameters(private_node);
  JointSensorOptions options = readJointSensorOptions(map);
  acceptDiagnosticPeriod(map);
  map.finish();
  return options;
}

JointSensorNode::JointSensorNode(const ros::NodeHandle& node,
                                 const ros::NodeHandle& private_node,
                                 const Actuator& actuator,
                                 const JointSensorOptions& options,
                                 std::unique_ptr<ModbusTransport> transport)
    : transport_(std::move(transport)),
      sensor_(options, *transport_),
      stream_("joint_states", limitsOfRate(options.rate)),
      timing_("polls", "reading", "poll"),
      link_diagnostics_(describe(options.link)),
      diagnostics_(node, private_node, actuator) {
  for (const JointAxis& joint : actuator.joints) {
    message_.name.push_back(joint.name);
  }
  message_.position.resize(kJoints);
  ros::NodeHandle handle = node;
  constexpr std::uint32_t kQueueLength = 10000;
  publisher_ = handle.advertise<sensor_msgs::JointState>("joint_states", kQueueLength);
  diagnostics_.add(link_diagnostics_);
  diagnostics_.add(stream_);
  diagnostics_.add(timing_);
  thread_ = std::make_unique<PeriodicThread>(options.rate, [this] { poll(); });
}

void JointSensorNode::poll() {
  const double begin = steadySeconds();
  if (!link_.mayTry(begin)) {
    return;
  }
  const bool was_up = link_.isUp();
  try {
    transport_->open();
    const double age = publishReading();
    timing_.add({begin, steadySeconds(), age});
    link_.success();
  } catch (const TransportError& error) {
    timing_.interrupt();
    link_.failure(begin, error.what());
    ROS_ERROR_STREAM_THROTTLE(kSensorWarningPeriod, error.what());
  } catch (const Error& error) {
    // The device answers; what it says is of no use.
    link_.success();
    stream_.refuse(error.what());
    ROS_WARN_STREAM_THROTTLE(kSensorWarningPeriod, error.what());
  }
  link_diagnostics_.update(link_);
  if (was_up != link_.isUp()) {
    diagnostics_.tellAtOnce();
  }
}

double JointSensorNode::publishReading() {
  const ros::Time before = ros::Time::now();
  const Eigen::Vector3d q = sensor_.read();
  const ros::Time after = ros::Time::now();
  message_.header.stamp = middleOf(before, after);
  for (std::size_t k = 0; k < kJoints; ++k) {
    message_.position[k] = q[static_cast<Eigen::Index>(k)];
  }
  publisher_.publish(message_);
  stream_.accept(message_.header.stamp);
  return secondsBetween(message_.header.stamp, ros::Time::now());
}

}  // namespace sac
