#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"
#include "spherical_actuator_calibration/drivers/joint_sensor.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"
#include "spherical_actuator_calibration/emulation/emulated_amplifier.hpp"
#include "spherical_actuator_calibration/emulation/modbus_server.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

constexpr int kAnyPort = 0;
constexpr std::size_t kCoils = 24;

/// The shipped configurations, at the port of an emulated device.
JointSensorOptions jointSensor(int port) {
  JointSensorOptions options =
      readJointSensorOptions(YamlMap::load(SOURCE_DIR "/config/joint_sensor.yaml"));
  options.link.port = port;
  return options;
}

CurrentAmplifierOptions coilDriver(int port) {
  CurrentAmplifierOptions options =
      readCurrentAmplifierOptions(YamlMap::load(SOURCE_DIR "/config/coil_driver.yaml"));
  options.link.port = port;
  return options;
}

TEST(ModbusServer, AnswersTheJointSensorDriver) {
  ModbusServer server("127.0.0.1", kAnyPort);
  server.addUnit(1);
  const JointSensorOptions options = jointSensor(server.port());
  const std::unique_ptr<ModbusTransport> transport = makeTransport(options.link);
  transport->open();
  JointSensor sensor(options, *transport);
  for (const Eigen::Vector3d& q : {Eigen::Vector3d(0.1, -0.25, 1.0),
                                   Eigen::Vector3d(-0.3, 0.2, 3.0),
                                   Eigen::Vector3d(0.0, 0.0, 3.3)}) {
    for (const RegisterContent& content : encodeJoints(options, q)) {
      server.setWords(content.unit, content.table, content.address, content.words);
    }
    EXPECT_LT((sensor.read() - q).cwiseAbs().maxCoeff(), 3e-5);
  }
}

TEST(ModbusServer, RefusesUnitsThatItHasNot) {
  ModbusServer server("127.0.0.1", kAnyPort);
  server.addUnit(1);
  ModbusLinkOptions link;
  link.port = server.port();
  const std::unique_ptr<ModbusTransport> transport = makeTransport(link);
  transport->open();
  EXPECT_EQ(transport->read(1, RegisterTable::kInput, 65530, 3).size(), 3U);
  try {
    transport->read(7, RegisterTable::kInput, 0, 1);
    ADD_FAILURE() << "unit 7 answered";
  } catch (const TransportError& error) {
    EXPECT_EQ(error.failure(), TransportFailure::kRefused) << error.what();
  }
  EXPECT_EQ(transport->read(1, RegisterTable::kHolding, 0, 1).front(), 0);
}

TEST(ModbusServer, ServesManyAndOutlivesThoseThatGo) {
  ModbusServer server("127.0.0.1", kAnyPort);
  server.addUnit(1);
  server.setWords(1, RegisterTable::kInput, 4, {17, 18});
  ModbusLinkOptions link;
  link.port = server.port();
  const std::unique_ptr<ModbusTransport> first = makeTransport(link);
  first->open();
  for (int n = 0; n < 20; ++n) {
    const std::unique_ptr<ModbusTransport> other = makeTransport(link);
    other->open();
    EXPECT_EQ(other->read(1, RegisterTable::kInput, 4, 2)[1], 18);
    other->close();
  }
  EXPECT_EQ(first->read(1, RegisterTable::kInput, 4, 1).front(), 17);
}

TEST(ModbusServer, RegistersAreThoseOfTheTimeOfTheRequest) {
  ModbusServer server("127.0.0.1", kAnyPort);
  server.addUnit(1);
  std::uint16_t requests = 0;
  server.beforeRequest([&] { server.setWords(1, RegisterTable::kInput, 4, {++requests}); });
  ModbusLinkOptions link;
  link.port = server.port();
  const std::unique_ptr<ModbusTransport> transport = makeTransport(link);
  transport->open();
  for (std::uint16_t n = 1; n <= 3; ++n) {
    EXPECT_EQ(transport->read(1, RegisterTable::kInput, 4, 1).front(), n);
  }
  server.beforeRequest({});
  EXPECT_EQ(transport->read(1, RegisterTable::kInput, 4, 1).front(), 3);
}

TEST(ModbusServer, NamesThePortThatIsTaken) {
  const ModbusServer server("127.0.0.1", kAnyPort);
  try {
    const ModbusServer other("127.0.0.1", server.port());
    ADD_FAILURE() << "two servers at one port";
  } catch (const TransportError& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(server.port())), std::string::npos);
  }
}

/// The amplifier driver against the emulated amplifier.
class EmulatedAmplifierTest : public testing::Test {
 protected:
  EmulatedAmplifierTest() { transport_->open(); }

  static Eigen::VectorXd pattern(double current) {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(kCoils);
    result[3] = current;
    result[20] = -0.5 * current;
    return result;
  }

  ModbusServer server_{"127.0.0.1", kAnyPort};
  CurrentAmplifierOptions options_ = coilDriver(server_.port());
  EmulatedAmplifier device_{options_, {2e-3, 0.5}, kCoils, server_};
  std::unique_ptr<ModbusTransport> transport_ = makeTransport(options_.link);
  CurrentAmplifier driver_{options_, kCoils, *transport_};
};

TEST_F(EmulatedAmplifierTest, FollowsSetpointsWithItsLag) {
  driver_.write(pattern(1.5), OutputStages::kOn);
  device_.advance(2e-3);
  EXPECT_NEAR(device_.currents()[3], 1.5 * (1.0 - std::exp(-1.0)), 1e-9);
  device_.advance(0.1);
  EXPECT_LT((device_.currents() - pattern(1.5)).norm(), 1e-9);
  device_.show(device_.currents());
  EXPECT_LT((driver_.read().currents - pattern(1.5)).cwiseAbs().maxCoeff(), 0.51e-3);
}

TEST_F(EmulatedAmplifierTest, ASetpointWorksAfterItsDelay) {
  constexpr double kLag = 2e-3;
  EmulatedAmplifier late(options_, {kLag, 0.5, 5e-3}, kCoils, server_);
  driver_.write(pattern(1.5), OutputStages::kOn);
  late.advance(4e-3);
  EXPECT_TRUE(late.currents().isZero());
  // 1 ms after it began to work, whatever the steps.
  late.advance(2e-3);
  EXPECT_NEAR(late.currents()[3], 1.5 * (1.0 - std::exp(-1e-3 / kLag)), 1e-9);
  late.advance(0.1);
  driver_.write(pattern(-0.5), OutputStages::kOn);
  late.advance(4e-3);
  EXPECT_NEAR(late.currents()[3], 1.5, 1e-9);
}

TEST_F(EmulatedAmplifierTest, GivesNoCurrentWithItsOutputStagesOff) {
  driver_.write(pattern(1.5), OutputStages::kOff);
  device_.advance(0.1);
  EXPECT_TRUE(device_.currents().isZero());
}

TEST_F(EmulatedAmplifierTest, TripsAndRecovers) {
  driver_.write(pattern(1.5), OutputStages::kOn);
  device_.advance(0.1);
  EXPECT_FALSE(driver_.isTripped());
  device_.setTripped(true);
  EXPECT_TRUE(driver_.isTripped());
  device_.advance(0.1);
  EXPECT_LT(device_.currents().norm(), 1e-9);
  device_.setTripped(false);
  EXPECT_FALSE(driver_.isTripped());
}

TEST_F(EmulatedAmplifierTest, AnswersOneRequestForAll) {
  CurrentAmplifierOptions options = options_;
  options.heartbeat_address = 24;
  options.currents.table = RegisterTable::kHolding;
  options.currents.address = 200;
  options.tripped->table = RegisterTable::kHolding;
  options.tripped->address = 224;
  options.one_request = true;
  EmulatedAmplifier device(options, {2e-3, 0.5}, kCoils, server_);
  CurrentAmplifier driver(options, kCoils, *transport_);
  driver.exchange(pattern(0.0), OutputStages::kOn, Heartbeat::kGiven);
  int requests = 0;
  server_.beforeRequest([&] { ++requests; });
  EXPECT_TRUE(
      driver.exchange(pattern(1.5), OutputStages::kOn, Heartbeat::kGiven).currents.isZero());
  device.advance(0.1);
  device.show(device.currents());
  device.setTripped(true);
  const AmplifierReading reading =
      driver.exchange(pattern(-0.5), OutputStages::kOn, Heartbeat::kGiven);
  server_.beforeRequest({});
  EXPECT_EQ(requests, 2);
  EXPECT_LT((reading.currents - pattern(1.5)).cwiseAbs().maxCoeff(), 0.51e-3);
  EXPECT_TRUE(reading.tripped);
  EXPECT_EQ(server_.words(2, RegisterTable::kHolding, 24, 1).front(), 3);
}

TEST_F(EmulatedAmplifierTest, ItsOwnWatchdogEndsTheCurrent) {
  driver_.write(pattern(1.5), OutputStages::kOn);
  device_.advance(0.1);  // sees the first heartbeat
  device_.advance(0.4);
  EXPECT_GT(device_.currents()[3], 1.0);
  device_.advance(0.2);
  EXPECT_LT(device_.currents().norm(), 1e-9);
  driver_.write(pattern(1.5), OutputStages::kOn);
  device_.advance(0.1);
  EXPECT_GT(device_.currents()[3], 1.0);
}

TEST_F(EmulatedAmplifierTest, RefusesDynamicsThatCannotBe) {
  EXPECT_THROW(EmulatedAmplifier(options_, {-1.0, 0.5}, kCoils, server_), ConfigError);
  EXPECT_THROW(EmulatedAmplifier(options_, {0.0, 0.0}, kCoils, server_), ConfigError);
}

}  // namespace
}  // namespace sac
