#include "spherical_actuator_calibration/drivers/joint_sensor.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/error_message.hpp"
#include "support/scripted_transport.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

constexpr char kShippedSensorFile[] = SOURCE_DIR "/config/joint_sensor.yaml";

JointSensorOptions shippedSensorOptions() {
  return readJointSensorOptions(YamlMap::load(kShippedSensorFile));
}

void put(const JointSensorOptions& options, const Eigen::Vector3d& q, ScriptedTransport& bus) {
  for (const RegisterContent& content : encodeJoints(options, q)) {
    bus.set(content.unit, content.table, content.address, content.words);
  }
}

std::string configError(const std::string& text) {
  return errorMessage<ConfigError>([&] {
    const YamlMap map = YamlMap::parse(text, "s.yaml");
    readJointSensorOptions(map);
    map.finish();
  });
}

TEST(JointSensor, ReadsTheAnglesThatItsRegistersHold) {
  JointSensorOptions options = shippedSensorOptions();
  options.tilt->matrix << 1.01, 0.02, -0.015, 0.98;
  options.tilt->x.zero = 1200.0;
  options.tilt->y.sign = -1;
  ScriptedTransport bus;
  bus.open();
  for (const Eigen::Vector3d& q : {Eigen::Vector3d(0.3, -0.2, 1.0),
                                   Eigen::Vector3d(-0.6, 0.6, 3.0),
                                   Eigen::Vector3d(0.0, 0.0, 0.0)}) {
    put(options, q, bus);
    JointSensor sensor(options, bus);
    const Eigen::Vector3d read = sensor.read();
    EXPECT_LT((read - q).head<2>().cwiseAbs().maxCoeff(), 3e-6);
    EXPECT_NEAR(read[2], q[2], 0.5 * 2.0 * kPi / 131072.0 + 1e-12);
  }
}

TEST(JointSensor, TiltChannelsTellComponentsOfGravity) {
  const Eigen::Vector2d q(0.4, -0.5);
  // g in the moved frame: (−cos q₁ sin q₂, sin q₁, cos q₁ cos q₂).
  const Eigen::Vector2d inclinations = inclinationsOf(q);
  EXPECT_NEAR(std::sin(inclinations[0]), std::sin(q[0]), 1e-15);
  EXPECT_NEAR(std::sin(inclinations[1]), std::cos(q[0]) * std::sin(q[1]), 1e-15);
  EXPECT_LT((*jointsOf(inclinations) - q).norm(), 1e-14);
  EXPECT_FALSE(jointsOf({1.2, 1.2}));
  EXPECT_FALSE(jointsOf({std::nan(""), 0.0}));
}

TEST(JointSensor, ReadsNeighbouringRegistersInOneRequest) {
  ScriptedTransport bus;
  bus.open();
  JointSensor sensor(shippedSensorOptions(), bus);
  ASSERT_EQ(sensor.requests().size(), 1U);
  EXPECT_EQ(sensor.requests()[0].count, 6);
  sensor.read();
  EXPECT_EQ(bus.reads(), 1);

  JointSensorOptions apart = shippedSensorOptions();
  apart.encoders[0].field.unit = 3;
  EXPECT_EQ(JointSensor(apart, bus).requests().size(), 2U);
  apart = shippedSensorOptions();
  apart.encoders[0].field.address = 500;
  EXPECT_EQ(JointSensor(apart, bus).requests().size(), 2U);
}

TEST(JointSensor, EncoderGoesOnThroughTheEndOfItsRange) {
  const JointSensorOptions options = shippedSensorOptions();
  ScriptedTransport bus;
  bus.open();
  JointSensor sensor(options, bus);
  for (double angle = 0.0; angle < 15.0; angle += 0.7) {
    put(options, {0.0, 0.0, angle}, bus);
    EXPECT_NEAR(sensor.read()[2], angle, 1e-4);
  }
  for (double angle = 14.7; angle > -15.0; angle -= 0.7) {
    put(options, {0.0, 0.0, angle}, bus);
    EXPECT_NEAR(sensor.read()[2], angle, 1e-4);
  }
}

TEST(JointSensor, BeginsWithTheAngleNearestToZero) {
  const JointSensorOptions options = shippedSensorOptions();
  ScriptedTransport bus;
  bus.open();
  put(options, {0.0, 0.0, 6.0}, bus);
  EXPECT_NEAR(JointSensor(options, bus).read()[2], 6.0 - 2.0 * kPi, 1e-4);
}

TEST(JointSensor, RefusesWhatNoPoseHas) {
  JointSensorOptions options = shippedSensorOptions();
  ScriptedTransport bus;
  bus.open();
  JointSensor sensor(options, bus);
  bus.set(1, RegisterTable::kInput, 0, options.tilt->x.encode(1.4));
  bus.set(1, RegisterTable::kInput, 2, options.tilt->y.encode(1.4));
  EXPECT_NE(errorMessage<DataError>([&] { sensor.read(); }).find("which no pose has"),
            std::string::npos);

  options.encoders[0].field.type = RegisterType::kFloat32;
  JointSensor floating(options, bus);
  bus.set(1, RegisterTable::kInput, 0, {0, 0, 0, 0, 0x7FC0, 0});
  EXPECT_NE(errorMessage<DataError>([&] { floating.read(); }).find("encoder"), std::string::npos);
}

TEST(JointSensor, ThreeEncodersServeAsWell) {
  const JointSensorOptions options = readJointSensorOptions(YamlMap::parse(
      "link: {type: rtu, device: /dev/ttyUSB0, baud: 19200, parity: none}\n"
      "encoders:\n"
      "  - {joint: 2, unit: 4, address: 10, type: int16, scale: 1.0e-3}\n"
      "  - {joint: 1, unit: 3, address: 10, type: float32, word_order: low_first, scale: 1.0}\n"
      "  - {joint: 3, unit: 5, address: 10, type: int32, scale: 1.0e-5}\n",
      "s.yaml"));
  EXPECT_EQ(options.link.parity, 'N');
  EXPECT_EQ(options.link.baud, 19200);
  ScriptedTransport bus;
  bus.open();
  put(options, {0.25, -0.125, 9.0}, bus);
  JointSensor sensor(options, bus);
  EXPECT_LT((sensor.read() - Eigen::Vector3d(0.25, -0.125, 9.0)).norm(), 1e-9);
}

// As the description's joints do: taken over from there, the rotor is where it was.
TEST(JointSensor, TakesOverWhatACalibrationIdentifiedOfTheReadings) {
  const std::string text =
      "link: {type: tcp, host: h}\n"
      "encoders:\n"
      "  - {joint: 1, address: 0, type: int32, scale: 1.0e-9}\n"
      "  - {joint: 2, address: 2, type: int32, scale: 1.0e-9}\n"
      "  - {joint: 3, address: 4, type: int32, scale: 1.0e-9}\n";
  const JointSensorOptions options = readJointSensorOptions(
      YamlMap::parse(text + "corrections:\n"
                            "  - {joint: 3, harmonics: [2.0e-3, -1.0e-3, 5.0e-4, 3.0e-4]}\n"
                            "  - {joint: 1, linear: [2.0e-3, -3.0e-3, 1.0e-3], "
                            "harmonics: [0.0, 1.0e-3, 0.0, -2.0e-3]}\n",
                     "s.yaml"));
  std::array<JointAxis, kJoints> joints = freeRotorJoints();
  joints[1].offset = 0.01;
  const JointGeometry uncorrected = jointGeometry(joints);
  joints[0].correction = {{2e-3, -3e-3, 1e-3}, {0.0, 1e-3, 0.0, -2e-3}};
  joints[2].correction.harmonics = {2e-3, -1e-3, 5e-4, 3e-4};
  const JointGeometry corrected = jointGeometry(joints);
  ScriptedTransport bus;
  bus.open();
  JointSensor sensor(options, bus);
  for (const Eigen::Vector3d& raw :
       {Eigen::Vector3d(0.5, -0.6, 2.0), Eigen::Vector3d(-0.4, 0.3, -1.5)}) {
    put(readJointSensorOptions(YamlMap::parse(text, "s.yaml")), raw, bus);
    const Eigen::Vector3d read = sensor.read();
    EXPECT_GT((read - raw).norm(), 1e-3);
    EXPECT_LT((rotorOrientation(uncorrected, read) - rotorOrientation(corrected, raw)).norm(),
              1e-12);
    // Devices that are emulated hold what the sensor takes for these angles.
    put(options, raw, bus);
    EXPECT_LT((sensor.read() - raw).norm(), 1e-9);
  }
}

TEST(JointSensor, ConfigurationErrorsNameTheKey) {
  const std::string link = "link: {type: tcp, host: h}\n";
  const std::string encoder = "{joint: 3, address: 0, type: int16, scale: 1.0}";
  EXPECT_NE(configError(link + "encoders: [" + encoder + "]\n").find("joint 1 has 0 sensors"),
            std::string::npos);
  EXPECT_NE(configError(link + "encoders: [{joint: 3, address: 0, type: int8, scale: 1.0}]\n")
                .find("encoders[0].type"),
            std::string::npos);
  EXPECT_NE(configError(link + "encoders: [{joint: 3, address: 0, type: int16, scale: 0.0}]\n")
                .find("encoders[0].scale"),
            std::string::npos);
  std::string corrections = link + "encoders:\n";
  for (const char* joint : {"1", "2", "3"}) {
    corrections += std::string("  - {joint: ") + joint + ", address: 0, type: int16, scale: 1.0}\n";
  }
  corrections += "corrections: ";
  for (const auto& [text, key] :
       {std::pair{"[{joint: 4}]", "corrections[0].joint"},
        std::pair{"[{joint: 1, linear: [0.1]}]", "corrections[0].linear"},
        std::pair{"[{joint: 1, linear: [0.0, 0.6, 0.0]}]", "corrections[0].linear"},
        std::pair{"[{joint: 1, harmonics: [.nan, 0.0, 0.0, 0.0]}]", "corrections[0].harmonics"},
        std::pair{"[{joint: 2}, {joint: 2}]", "corrections[1].joint"}}) {
    EXPECT_NE(configError(corrections + text + "\n").find(key), std::string::npos)
        << configError(corrections + text + "\n");
  }
  EXPECT_NE(configError("link: {type: can}\nencoders: []\n").find("link.type"), std::string::npos);
  EXPECT_NE(configError("link: {type: rtu}\nencoders: []\n").find("link.device"),
            std::string::npos);
  EXPECT_NE(configError(link + "rate: 0.0\nencoders: []\n").find("rate"), std::string::npos);
}

}  // namespace
}  // namespace sac
