#pragma once

#include <string>

#include <ros/node_handle.h>

#include "spherical_actuator_calibration/base/yaml_reader.hpp"

namespace XmlRpc {
class XmlRpcValue;
}

namespace sac {

/// YAML text of a value of the parameter server, so that what `rosparam load` put there is read and
/// checked by the same code as a file. Numbers keep every bit, strings are quoted. Throws
/// ConfigError, naming `key`, for types that YAML files of this package cannot hold (dates, binary
/// data).
std::string yamlOfParameter(const XmlRpc::XmlRpcValue& value, const std::string& key);

/// The parameters below a key, read as a file: for the key "actuator" a map with the one key
/// "actuator". Messages name the namespace of the node handle: "/lab: actuator.joints[0].axis:
/// ...". Throws ConfigError, naming the whole key, when there are none.
YamlMap requiredParameters(const ros::NodeHandle& node, const std::string& key);

/// All private parameters of a node; an empty map when it has none. Messages name the node:
/// "/lab/coil_driver: watchdog: ...".
YamlMap privateParameters(const ros::NodeHandle& private_node);

}  // namespace sac
