#include "spherical_actuator_calibration/actuator/urdf_file.hpp"

#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/error_message.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

constexpr const char* kRobot = R"(<?xml version="1.0" encoding="utf-8"?>
<!-- first comment -->
<robot name="test" xmlns:x="urn:x">
  <x:unknown deep="1"><y>text &amp; more</y></x:unknown>
  <transmission name="t"><joint name="joint_2"><hardwareInterface>e</hardwareInterface></joint></transmission>
  <link name="stator"/>
  <link name="a"/>
  <link name="b"/>
  <link name="rotor"/>
  <joint name="joint_1" type="revolute" future="yes">
    <!-- second comment -->
    <origin xyz="0.1 0.2 0.30000000000000004" rpy="0 0 0"/>
    <parent link="stator"/>
    <child link="a"/>
    <axis xyz="1 0 0"/>
    <limit lower="-0.6" upper="0.6" effort="2" velocity="10"/>
    <invented value="7"/>
  </joint>
  <joint name="joint_2" type="continuous">
    <origin xyz="0 0 0.5" rpy="0 0.1 0"/>
    <parent link="a"/>
    <child link="b"/>
    <axis xyz="0 2 0"/>
  </joint>
  <joint name="joint_3" type="continuous">
    <parent link="b"/>
    <child link="rotor"/>
    <axis xyz="0 0 1"/>
  </joint>
</robot>
)";

JointNames jointNames() {
  return {"joint_1", "joint_2", "joint_3"};
}

/// What kRobot describes.
Actuator nominalActuator() {
  Actuator actuator;
  actuator.joints = {JointAxis{"joint_1", Eigen::Vector3d::UnitX(), 0.0},
                     JointAxis{"joint_2", Eigen::Vector3d::UnitY(), 0.1},
                     JointAxis{"joint_3", Eigen::Vector3d::UnitZ(), 0.0}};
  return actuator;
}

Actuator calibratedActuator() {
  Actuator actuator = nominalActuator();
  actuator.joints[0].axis = Eigen::Vector3d(0.99938, -0.0157, 0.03141).normalized();
  actuator.joints[0].offset = 0.03;
  actuator.joints[1].axis = Eigen::Vector3d(0.01745, 0.99963, -0.02094).normalized();
  actuator.joints[1].offset = 0.125;
  actuator.joints[2].axis = Eigen::Vector3d(0.01571, 0.01047, 0.99982).normalized();
  actuator.joints[2].offset = -0.02;
  return actuator;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Largest difference of axes and offsets.
double difference(const std::array<JointAxis, kJoints>& a,
                  const std::array<JointAxis, kJoints>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < kJoints; ++k) {
    largest = std::max({largest,
                        (a[k].axis - b[k].axis).cwiseAbs().maxCoeff(),
                        std::abs(a[k].offset - b[k].offset)});
  }
  return largest;
}

TEST(UrdfFile, ReadsAxesAndOffsets) {
  const TemporaryFolder folder;
  const auto joints = readJoints(folder.write("a.urdf", kRobot), jointNames());
  EXPECT_EQ(joints[1].name, "joint_2");
  EXPECT_LT(difference(joints, nominalActuator().joints), 1e-15);
}

TEST(UrdfFile, WrittenAxesAndOffsetsComeBackExactly) {
  const TemporaryFolder folder;
  const std::string robot = folder.write("a.urdf", kRobot);
  std::mt19937 generator(7);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> angle(-3.14, 3.14);
  for (int trial = 0; trial < 60; ++trial) {
    Actuator calibrated = nominalActuator();
    for (JointAxis& joint : calibrated.joints) {
      joint.axis =
          Eigen::Vector3d(gauss(generator), gauss(generator), gauss(generator)).normalized();
      // Small offsets as well as large ones.
      joint.offset = angle(generator) * std::pow(10.0, -(trial % 10));
    }
    writeCalibratedUrdf(
        robot, folder.path("b.urdf"), nominalActuator(), calibrated, OverwritePolicy::kReplace);
    EXPECT_LT(difference(readJoints(folder.path("b.urdf"), jointNames()), calibrated.joints),
              1e-12);
  }
}

TEST(UrdfFile, OffsetsComeBackExactlyWhereRollAndYawTurnAboutOneAxis) {
  const TemporaryFolder folder;
  const std::string robot = folder.write("a.urdf", kRobot);
  for (const double deviation : {0.0, 1e-12, -1e-9, 1e-8, -1e-7, 1e-4}) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::AngleAxisd turn(
          Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(sign * kPi / 2.0 + deviation, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitX()));
      Actuator calibrated = calibratedActuator();
      calibrated.joints[1].axis = turn.axis().normalized();
      calibrated.joints[1].offset = turn.angle();
      writeCalibratedUrdf(
          robot, folder.path("b.urdf"), nominalActuator(), calibrated, OverwritePolicy::kReplace);
      EXPECT_LT(difference(readJoints(folder.path("b.urdf"), jointNames()), calibrated.joints),
                1e-12)
          << deviation;
    }
  }
}

TEST(UrdfFile, RendersTheSameFromTextAsFromAFile) {
  const TemporaryFolder folder;
  writeCalibratedUrdf(folder.write("a.urdf", kRobot),
                      folder.path("b.urdf"),
                      nominalActuator(),
                      calibratedActuator(),
                      OverwritePolicy::kRefuse);
  EXPECT_EQ(
      renderCalibratedUrdf(kRobot, "robot_description", nominalActuator(), calibratedActuator()),
      contentOf(folder.path("b.urdf")));
  EXPECT_THROW(renderCalibratedUrdf("<robot", "x", nominalActuator(), calibratedActuator()),
               ConfigError);
}

TEST(UrdfFile, LosesNothingOfTheOriginal) {
  const TemporaryFolder folder;
  const std::string robot = folder.write("a.urdf", kRobot);
  writeCalibratedUrdf(robot,
                      folder.path("b.urdf"),
                      nominalActuator(),
                      calibratedActuator(),
                      OverwritePolicy::kRefuse);
  const std::string text = contentOf(folder.path("b.urdf"));
  // In the order of the original.
  std::size_t at = 0;
  for (const char* const passage :
       {"<?xml version=\"1.0\" encoding=\"utf-8\"?>",
        "<!-- first comment -->",
        "<robot name=\"test\" xmlns:x=\"urn:x\">",
        "<x:unknown deep=\"1\">",
        "<y>text &amp; more</y>",
        "<transmission name=\"t\">",
        "<hardwareInterface>e</hardwareInterface>",
        "<link name=\"stator\"/>",
        "type=\"revolute\" future=\"yes\">",
        "<!-- second comment -->",
        "<origin xyz=\"0.1 0.2 0.30000000000000004\" rpy=",
        "<parent link=\"stator\"/>",
        "<axis xyz=\"0.999",
        "<limit lower=\"-0.6\" upper=\"0.6\" effort=\"2\" velocity=\"10\"/>",
        "<invented value=\"7\"/>",
        "<origin xyz=\"0 0 0.5\" rpy=",
        "<joint name=\"joint_3\""}) {
    const std::size_t found = text.find(passage, at);
    ASSERT_NE(found, std::string::npos) << passage << "\n" << text;
    at = found;
  }
}

TEST(UrdfFile, NominalParametersChangeNothing) {
  const TemporaryFolder folder;
  const std::string robot = folder.write("a.urdf", kRobot);
  const Actuator nominal = nominalActuator();
  writeCalibratedUrdf(robot, folder.path("b.urdf"), nominal, nominal, OverwritePolicy::kRefuse);
  EXPECT_LT(difference(readJoints(folder.path("b.urdf"), jointNames()), nominal.joints), 1e-15);
  const std::string text = contentOf(folder.path("b.urdf"));
  EXPECT_EQ(text.find("-0 "), std::string::npos) << text;
  EXPECT_EQ(text.find("-0\""), std::string::npos) << text;
}

TEST(UrdfFile, RefusesATemplateOfAnotherActuator) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) {
    const std::string robot = folder.write("a.urdf", text);
    return errorMessage<ConfigError>([&] {
      writeCalibratedUrdf(robot,
                          folder.path("b.urdf"),
                          nominalActuator(),
                          calibratedActuator(),
                          OverwritePolicy::kRefuse);
    });
  };
  const std::string start = folder.path("a.urdf") + ": joint ";
  EXPECT_EQ(message(replaced(kRobot, "xyz=\"0 0 1\"", "xyz=\"0 1e-5 1\""))
                .find(start + "\"joint_3\": its axis is not the nominal one"),
            0U);
  EXPECT_EQ(message(replaced(kRobot, "xyz=\"0 0 1\"", "xyz=\"0 0 -1\""))
                .find(start + "\"joint_3\": its axis is not the nominal one"),
            0U);
  EXPECT_EQ(message(replaced(kRobot, "rpy=\"0 0.1 0\"", "rpy=\"0 0.11 0\""))
                .find(start + "\"joint_2\": the rotation of its origin is not the nominal offset"),
            0U);
  EXPECT_EQ(message(replaced(kRobot, "rpy=\"0 0 0\"", "rpy=\"0 0 0.01\""))
                .find(start + "\"joint_1\": its origin turns about another axis"),
            0U);
  EXPECT_EQ(folder.files(), 1);
}

TEST(UrdfFile, NamesTheJointThatIsWrong) {
  const TemporaryFolder folder;
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"<joint name=\"joint_3\"", "<joint name=\"spin\"", "the joint \"joint_3\" is missing."},
      {"name=\"joint_2\" type=\"continuous\"",
       "name=\"joint_2\" type=\"fixed\"",
       "joint \"joint_2\": its type must be revolute or continuous."},
      {"<parent link=\"b\"/>",
       "<parent link=\"a\"/>",
       "joint \"joint_3\": its parent link is \"a\"; it must be \"b\", the child link of "
       "\"joint_2\"."},
      {"<axis xyz=\"0 0 1\"/>",
       "<axis xyz=\"0 0 0\"/>",
       "joint \"joint_3\": its axis has no direction."},
  };
  for (const auto& [from, to, expected] : cases) {
    const std::string robot = folder.write("a.urdf", replaced(kRobot, from, to));
    EXPECT_EQ(errorMessage<ConfigError>([&] { readJoints(robot, jointNames()); }),
              std::string(robot).append(": ").append(expected));
  }
}

TEST(UrdfFile, AxesOfAnyLengthAreDirections) {
  const TemporaryFolder folder;
  for (const char* const axis : {"0 0 1e-200", "0 0 1e200"}) {
    const std::string robot = folder.write(
        "a.urdf",
        replaced(kRobot, "<axis xyz=\"0 0 1\"/>", "<axis xyz=\"" + std::string(axis) + "\"/>"));
    EXPECT_EQ(readJoints(robot, jointNames())[2].axis, Eigen::Vector3d::UnitZ()) << axis;
  }
}

TEST(UrdfFile, RefusesWhatIsNoRobotDescription) {
  const TemporaryFolder folder;
  const auto message = [](const std::string& path) {
    return errorMessage<ConfigError>([&] { readJoints(path, jointNames()); });
  };
  EXPECT_NE(message(folder.path("missing.urdf")).find("cannot be read: No such file"),
            std::string::npos);
  const std::string cut = std::string(kRobot).substr(0, 600);
  EXPECT_NE(message(folder.write("cut.urdf", cut)).find("cannot be read as XML"),
            std::string::npos);
  EXPECT_NE(message(folder.write("other.urdf", "<html/>")).find("not a robot description"),
            std::string::npos);
}

TEST(UrdfFile, RefusesElementsWithTooManyAttributes) {
  const auto said = [](const std::string& begin, int attributes) {
    std::string text = begin;
    for (int n = 0; n < attributes; ++n) {
      text += " a" + std::to_string(n) + "='>\" ='";
    }
    text += "/></robot>";
    return errorMessage<ConfigError>(
        [&] { renderCalibratedUrdf(text, "r", nominalActuator(), calibratedActuator()); });
  };
  const std::string refusal =
      "r:2: an element has more than 100 attributes, where URDF knows a handful: take out what "
      "does not belong.";
  EXPECT_EQ(said("<robot name=\"r\">\n<link name='l'", 20000), refusal);
  EXPECT_EQ(said("<robot name=\"r\">\n<link", 101), refusal);
  EXPECT_EQ(said("<robot><!-- don't > <a --><!x '>\n<?p \"?><![CDATA[ < ' ]]><link", 101), refusal);
  EXPECT_EQ(said("<robot name=\"r\">\n<link", 100).find("attributes"), std::string::npos);
}

TEST(UrdfFile, TheShippedRobotFitsTheShippedActuator) {
  const TemporaryFolder folder;
  const Actuator nominal = loadActuator(SOURCE_DIR "/config/pm_spherical_8x24.yaml");
  Actuator calibrated = nominal;
  calibrated.joints = calibratedActuator().joints;
  writeCalibratedUrdf(SOURCE_DIR "/urdf/pm_spherical_8x24.urdf",
                      folder.path("b.urdf"),
                      nominal,
                      calibrated,
                      OverwritePolicy::kRefuse);
  EXPECT_LT(difference(readJoints(folder.path("b.urdf"), jointNames()), calibrated.joints), 1e-12);
}

}  // namespace
}  // namespace sac
