#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"

#include <string>

#include <gtest/gtest.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

using XmlRpc::XmlRpcValue;

/// What the parameter server holds after `rosparam load` of a small description.
XmlRpcValue descriptionParameter() {
  XmlRpcValue actuator;
  actuator["name"] = std::string("small");
  actuator["serial"] = std::string("007");
  for (int k = 0; k < 3; ++k) {
    XmlRpcValue joint;
    joint["name"] = "joint_" + std::to_string(k + 1);
    for (int i = 0; i < 3; ++i) {
      joint["axis"][i] = i == k ? 1 : 0;  // rosparam keeps "1" a whole number
    }
    joint["offset"] = 0.1 + k;
    actuator["joints"][k] = joint;
  }
  actuator["workspace"]["tilt_limit"] = 0.6;
  return actuator;
}

TEST(ParameterMap, IsReadAsADescriptionFile) {
  const std::string text = "actuator: " + yamlOfParameter(descriptionParameter(), "/actuator");
  const Actuator actuator = parseDescription(text, "/actuator").actuator;
  EXPECT_EQ(actuator.name, "small");
  EXPECT_EQ(actuator.serial, "007");
  EXPECT_EQ(actuator.joints[1].axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(actuator.joints[2].offset, 2.1);
}

TEST(ParameterMap, KeepsEveryBitOfANumber) {
  for (const double value : {0.1, 1.0 / 3.0, -2.5e-300, 1e22, 0.0}) {
    XmlRpcValue map;
    map["x"] = value;
    EXPECT_EQ(YamlMap::parse(yamlOfParameter(map, "/p"), "/p").number("x", ValueRange::finite()),
              value);
  }
}

TEST(ParameterMap, KeepsTypesApart) {
  XmlRpcValue map;
  map["truth"] = true;
  map["word"] = std::string("true");
  map["digits"] = std::string("12");
  map["whole"] = 12;
  const YamlMap read = YamlMap::parse(yamlOfParameter(map, "/p"), "/p");
  EXPECT_TRUE(read.boolean("truth"));
  EXPECT_EQ(read.text("word"), "true");
  EXPECT_EQ(read.text("digits"), "12");
  EXPECT_EQ(read.integer("whole", 0, 100), 12);
  EXPECT_THROW(read.boolean("word"), ConfigError);
}

TEST(ParameterMap, NamesAValueThatCannotBeUsed) {
  XmlRpcValue map;
  map["list"][0] = 1;
  std::string bytes = "binary";
  map["list"][1] = XmlRpcValue(bytes.data(), static_cast<int>(bytes.size()));
  EXPECT_NE(errorMessage<ConfigError>([&] { yamlOfParameter(map, "/p"); }).find("/p/list[1]"),
            std::string::npos);
}

}  // namespace
}  // namespace sac
