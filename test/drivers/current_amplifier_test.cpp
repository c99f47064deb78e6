#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"

#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/scripted_transport.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

constexpr char kShippedFile[] = SOURCE_DIR "/config/coil_driver.yaml";
constexpr int kUnit = 2;

CurrentAmplifierOptions shippedOptions() {
  return readCurrentAmplifierOptions(YamlMap::load(kShippedFile));
}

TEST(CurrentAmplifier, SplitsBlocksThatNoRequestHolds) {
  CurrentAmplifierOptions options = shippedOptions();
  options.setpoints.type = RegisterType::kFloat32;
  options.currents.type = RegisterType::kFloat32;
  options.setpoints.scale = options.currents.scale = 1.0;
  options.enable_address.reset();
  options.heartbeat_address.reset();
  constexpr std::size_t kMany = 150;
  ScriptedTransport bus;
  bus.open();
  CurrentAmplifier amplifier(options, kMany, bus);
  Eigen::VectorXd currents =
      Eigen::VectorXd::LinSpaced(kMany, -1.0, 1.0).cast<float>().cast<double>();
  amplifier.write(currents, OutputStages::kOn);
  EXPECT_EQ(bus.writes().size(), 3U);
  for (const ScriptedTransport::Write& write : bus.writes()) {
    EXPECT_LE(write.words.size(), 123U);
    EXPECT_EQ(write.words.size() % 2, 0U);
    bus.set(kUnit, RegisterTable::kInput, write.address, write.words);
  }
  EXPECT_EQ(amplifier.read(), currents);
}

TEST(CurrentAmplifier, WritesNothingOfACommandThatDoesNotFit) {
  CurrentAmplifierOptions options = shippedOptions();
  ScriptedTransport bus;
  bus.open();
  CurrentAmplifier amplifier(options, 2, bus);
  EXPECT_THROW(amplifier.write(Eigen::Vector2d(1.0, 40.0), OutputStages::kOn), DataError);
  EXPECT_TRUE(bus.writes().empty());
}

std::string refusalOf(const std::string& text) {
  return errorMessage<ConfigError>(
      [&] { readCurrentAmplifierOptions(YamlMap::parse(text, "c.yaml")); });
}

TEST(CurrentAmplifier, ConfigurationErrorsNameTheKey) {
  const std::string link = "link: {type: tcp, host: h}\n";
  EXPECT_NE(refusalOf(link + "limits: {coil: -1.0, total: 1.0, slew: 1.0}\n").find("limits.coil"),
            std::string::npos);
  EXPECT_NE(refusalOf(link + "limits: {coil: 1.0, total: 1.0, slew: 1.0}\n"
                             "setpoints: {table: input, address: 0, type: int16, scale: 1.0}\n")
                .find("setpoints.table"),
            std::string::npos);
  EXPECT_NE(refusalOf(link + "watchdog: 1.1\n").find("watchdog"), std::string::npos);
  EXPECT_NE(refusalOf(link + "rate: 5.0\n").find("rate"), std::string::npos);
  EXPECT_NE(refusalOf("link: {type: tcp, host: h, response_timeout: 1.5}\n")
                .find("link.response_timeout"),
            std::string::npos);
}

TEST(CurrentAmplifier, GoesWithoutAHeartbeatOnlyWhereThatIsAcceptedInWriting) {
  const std::string unattended =
      "link: {type: tcp, host: h}\n"
      "limits: {coil: 1.0, total: 1.0, slew: 1.0}\n"
      "setpoints: {address: 0, type: int16, scale: 1.0}\n"
      "currents: {address: 0, type: int16, scale: 1.0}\n";
  const std::string refusal = refusalOf(unattended);
  EXPECT_NE(refusal.find("heartbeat_address"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("unattended_amplifier: accepted"), std::string::npos) << refusal;
  EXPECT_NE(refusalOf(unattended + "unattended_amplifier: yes please\n").find("accepted"),
            std::string::npos);
  EXPECT_FALSE(readCurrentAmplifierOptions(
                   YamlMap::parse(unattended + "unattended_amplifier: accepted\n", "c.yaml"))
                   .heartbeat_address);
}

}  // namespace
}  // namespace sac
