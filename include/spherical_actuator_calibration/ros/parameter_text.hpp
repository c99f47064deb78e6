#pragma once

#include <string>

#include <ros/node_handle.h>

namespace XmlRpc {
class XmlRpcValue;
}

namespace spherical_actuator_calibration {

/// YAML text of a value of the parameter server, so that what `rosparam load` put there is read and
/// checked by the same code as a file. Numbers keep every bit, strings are quoted. Throws
/// ConfigError, naming `key`, for types that YAML files of this package cannot hold (dates, binary
/// data).
std::string yamlOfParameter(const XmlRpc::XmlRpcValue& value, const std::string& key);

/// The parameters below a key as the text of a YAML file: for the key "actuator" a file that begins
/// with "actuator:". Throws ConfigError, naming the whole key, when there are none.
std::string requiredParameterText(const ros::NodeHandle& node, const std::string& key);

/// All private parameters of a node as the text of a YAML file; "{}" when it has none.
std::string privateParameterText(const ros::NodeHandle& private_node);

}  // namespace spherical_actuator_calibration
