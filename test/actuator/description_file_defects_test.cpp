#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "actuator/description_example.hpp"

namespace sac {
namespace {

TEST(DescriptionFile, NamesFileLineAndKeyOfWhatIsOutOfRange) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"polar: 0.1",
       "polar: 2.1",
       ":10: actuator.poles[1].polar: 2.1 is outside [-1.5708, 1.5708]"},
      {"azimuth: 0.8", "azimuth: .inf", ":10: actuator.poles[1].azimuth: inf is not finite"},
      {"polarity: -1", "polarity: 2", ":10: actuator.poles[1].polarity: 2 is neither 1 nor -1."},
      {"polarity: 1}",
       "polarity: 1, gain: 0}",
       ":9: actuator.poles[0].gain: 0 is outside (0, inf)"},
      {"polar: 0.2618", "polar: .nan", ":12: actuator.coils[0].polar: nan is not finite"},
      {"[0, 1, 0]", "[0, 0.5, 0]", ":6: actuator.joints[1].axis: length: 0.5 is outside [0.999, "},
      {"[0, 1, 0]", "[0, .nan, 0]", ":6: actuator.joints[1].axis[1]: nan is not finite"},
      {"offset: 0.1", "offset: -.inf", ":6: actuator.joints[1].offset: -inf is not finite"},
      {"tilt_limit: 0.6",
       "tilt_limit: 1.6",
       ":14: actuator.workspace.tilt_limit: 1.6 is outside (0"},
      {"tilt_limit: 0.6", "tilt_limit: 0", ":14: actuator.workspace.tilt_limit: 0 is outside (0"},
      {"[28.0, 32.0]", "[28.0, 180.0]", ":13: actuator.torque_curve.support[1]: 180 is outside"},
      {"[28.0, 32.0]", "[32.0, 28.0]", ":13: actuator.torque_curve: torque_curve: angles must"},
      {"[0.0, 0.05]", "[]", ":13: actuator.torque_curve: torque_curve.coefficients: at least one"},
      {"blend_start: 2.0",
       "blend_start: 0",
       ":13: actuator.torque_curve.blend_start: 0 is outside"},
      {"[0.0, 0.05]",
       "[0.0, 0.0]",
       ":13: actuator.torque_curve: torque_curve: the largest torque is 0 N*m/A, with which no"},
      {"[0.0, 0.05]",
       "[0.0, 0.05e30]",
       ":13: actuator.torque_curve: torque_curve: the largest torque is 1.4e+30 N*m/A, which no"},
      {"coefficients: [0.0, 0.05]",
       "table: {angles: [0, 10, 20, 32], torques: [0, 0, 0, 0]}",
       ":13: actuator.torque_curve: torque_curve.table: the largest torque is 0 N*m/A, with"},
      {"coefficients: [0.0, 0.05]",
       "table: {angles: [0, 10, 20, 32], torques: [0, 3.0e+29, 2.0e+29, 0]}",
       ":13: actuator.torque_curve: torque_curve.table: the largest torque is "},
      {"revision: 2", "revision: -1", ":17: actuator.calibration.revision: -1 is outside [0, "},
      {"coil: 0", "coil: 1.5", ":21: actuator.calibration.cycles[0].coil: \"1.5\" is not a whole"},
      {"error_after: 0.001",
       "error_after: -1",
       ":21: actuator.calibration.cycles[0].error_after: -1"},
      {"date: 2024-05-31T", "date: 31.5.2024 ", ":16: actuator.calibration.date: \"31.5.2024 12:"},
  };
  for (const auto& [from, to, expected] : cases) {
    const std::string message = messageFor(spoilt(from, to));
    EXPECT_EQ(message.find("f.yaml" + expected), 0U) << to << ": " << message;
  }
}

TEST(DescriptionFile, NamesFileLineAndKeyOfAWrongType) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"name: test", "name: [test]", ":2: actuator.name: a list is not a string"},
      {"serial: unit-001", "serial: 1", ":3: actuator.serial: \"1\" is not a string"},
      {"name: joint_2", "name: ''", ":6: actuator.joints[1].name: the string is empty"},
      {"name: joint_2",
       "name: joint_1",
       ":6: actuator.joints[1].name: \"joint_1\" is another joint's"},
      {"axis: [0, 1, 0]", "axis: [0, 1]", ":6: actuator.joints[1].axis: the list has 2 numbers"},
      {"axis: [0, 1, 0]",
       "axis: [0, y, 0]",
       ":6: actuator.joints[1].axis[1]: \"y\" is not a number"},
      {"polarity: -1",
       "polarity: south",
       ":10: actuator.poles[1].polarity: \"south\" is not a whole"},
      {"azimuth: 0.8", "azimuth: '0.8'", ":10: actuator.poles[1].azimuth: \"0.8\" is not a number"},
      {"angle_unit: deg",
       "angle_unit: grad",
       ":13: actuator.torque_curve.angle_unit: \"grad\" is not"},
      {"workspace: {tilt_limit: 0.6}",
       "workspace: 0.6",
       ":14: actuator.workspace: \"0.6\" is not a map"},
      {"cycle: joint",
       "cycle: joints",
       ":21: actuator.calibration.cycles[0].cycle: \"joints\" is not"},
      {"unidentified: [joint_3/axis_u]", "unidentified: joint_3", ":22: actuator.calibration.unid"},
  };
  for (const auto& [from, to, expected] : cases) {
    const std::string message = messageFor(spoilt(from, to));
    EXPECT_EQ(message.find("f.yaml" + expected), 0U) << to << ": " << message;
  }
}

TEST(DescriptionFile, NamesAMissingKeyAndWhereItBelongs) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"  name: test\n", "", ":1: actuator.name: the key is missing."},
      {", offset: 0.1", "", ":6: actuator.joints[1].offset: the key is missing."},
      {", polarity: -1", "", ":10: actuator.poles[1].polarity: the key is missing."},
      {", support: [28.0, 32.0]", "", ":13: actuator.torque_curve.support: the key is missing."},
      {"  workspace: {tilt_limit: 0.6}\n", "", ":1: actuator.workspace: the key is missing."},
      {", unit: rad", "", ":21: actuator.calibration.cycles[0].unit: the key is missing."},
      {"    software: 0.1.0\n", "", ":15: actuator.calibration.software: the key is missing."},
  };
  for (const auto& [from, to, expected] : cases) {
    const std::string message = messageFor(spoilt(from, to));
    EXPECT_EQ(message, "f.yaml" + expected);
  }
}

TEST(DescriptionFile, RejectsKeysThatAreUnknownOrRepeated) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"  name: test", "  color: red\n  name: test", ":2: actuator.color: the key is unknown here"},
      {"polarity: -1", "polarity: -1, sign: 1", ":10: actuator.poles[1].sign: the key is unknown"},
      {"azimuth: 0.0}",
       "azimuth: 0.0, polarity: 1}",
       ":12: actuator.coils[0].polarity: the key is un"},
      {"offset: 0.1",
       "offset: 0.1, stddev: {axis_w: 1}",
       ":6: actuator.joints[1].stddev.axis_w: the"},
      {"revision: 2",
       "revision: 2\n    mood: good",
       ":18: actuator.calibration.mood: the key is unk"},
      {"actuator:",
       "rate: 1\nactuator:",
       ":1: rate: the key is unknown here; known are: actuator."},
      {"polar: 0.1",
       "polar: 0.1, polar: 0.1",
       ":10: actuator.poles[1].polar: the key is given twice"},
      {"  serial",
       "  name: again\n  serial",
       ":3: actuator.name: the key is given twice, first in l"},
  };
  for (const auto& [from, to, expected] : cases) {
    const std::string message = messageFor(spoilt(from, to));
    EXPECT_EQ(message.find("f.yaml" + expected), 0U) << to << ": " << message;
  }
}

TEST(DescriptionFile, NeedsThreeJointsOrNone) {
  EXPECT_EQ(messageFor(spoilt("    - {name: joint_3, axis: [0, 0, 1], offset: 0.0}\n", "")),
            "f.yaml:4: actuator.joints: the list has 2 joints; 3 are needed, or none where only "
            "a tracker tells the orientation.");
}

TEST(DescriptionFile, RefusesAnOrientationMapWithoutJoints) {
  const std::string map =
      "joints: []\n  orientation_map: {length: [1, 1, 1], amplitude: [1e-3, 1e-3, 1e-3], noise: "
      "[1e-4, 1e-4, 1e-4], points: [{reading: [0, 0, 0], rotation: [0, 0, 0]}]}\n";
  const std::string message = messageFor(withoutJoints(map));
  EXPECT_NE(message.find("orientation_map: the rotor has no joints"), std::string::npos) << message;
}

}  // namespace
}  // namespace sac
