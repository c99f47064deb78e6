#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"

#include <xmlrpcpp/XmlRpcValue.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"

namespace sac {
namespace {

using XmlRpc::XmlRpcValue;

std::string quoted(const std::string& text) {
  const std::string plain = yamlText(text);
  return plain.front() == '"' || plain.front() == '\'' ? plain : '"' + plain + '"';
}

std::string sequenceText(const XmlRpcValue& value, const std::string& key) {
  std::string text;
  for (int n = 0; n < value.size(); ++n) {
    text += (n == 0 ? "" : ", ") + yamlOfParameter(value[n], key + "[" + std::to_string(n) + "]");
  }
  return "[" + text + "]";
}

std::string nestedKey(const std::string& key, const std::string& name) {
  return key + "/" + name;
}

std::string mapText(const XmlRpcValue& value, const std::string& key) {
  std::string text;
  for (const auto& [name, entry] : value) {
    text += text.empty() ? "" : ", ";
    text += quoted(name);
    text += ": ";
    text += yamlOfParameter(entry, nestedKey(key, name));
  }
  return "{" + text + "}";
}

}  // namespace

std::string yamlOfParameter(const XmlRpcValue& value, const std::string& key) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return yamlBoolean(static_cast<bool>(value));
    case XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(value));
    case XmlRpcValue::TypeDouble:
      return yamlNumber(static_cast<double>(value));
    case XmlRpcValue::TypeString:
      return quoted(static_cast<std::string>(value));
    case XmlRpcValue::TypeArray:
      return sequenceText(value, key);
    case XmlRpcValue::TypeStruct:
      return mapText(value, key);
    default:
      throw ConfigError("The parameter " + key +
                        " is of a type that is not used here: no number, truth value, text, list "
                        "or map.");
  }
}

YamlMap requiredParameters(const ros::NodeHandle& node, const std::string& key) {
  XmlRpcValue value;
  if (!node.getParam(key, value)) {
    throw ConfigError("The parameter " + node.resolveName(key) +
                      " is missing: load the description with rosparam, or start the node by a "
                      "launch file of this package.");
  }
  const std::string text = quoted(key) + ": " + yamlOfParameter(value, node.resolveName(key));
  return YamlMap::parse(text, node.getNamespace(), LineNumbers::kOmitted);
}

YamlMap privateParameters(const ros::NodeHandle& private_node) {
  XmlRpcValue value;
  const std::string& name = private_node.getNamespace();
  const bool has_parameters =
      private_node.getParam(name, value) && value.getType() == XmlRpcValue::TypeStruct;
  return YamlMap::parse(
      has_parameters ? yamlOfParameter(value, name) : "{}", name, LineNumbers::kOmitted);
}

}  // namespace sac
