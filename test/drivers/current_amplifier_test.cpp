#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/shipped_coil_driver.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/scripted_transport.hpp"

namespace sac {
namespace {

TEST(CurrentAmplifier, SplitsBlocksThatNoRequestHolds) {
  CurrentAmplifierOptions options = shippedOptions();
  options.setpoints.type = RegisterType::kFloat32;
  options.currents.type = RegisterType::kFloat32;
  options.setpoints.scale = options.currents.scale = 1.0;
  options.enable_address.reset();
  options.heartbeat_address.reset();
  options.tripped.reset();
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
  EXPECT_EQ(amplifier.read().currents, currents);
}

TEST(CurrentAmplifier, WritesAHeartbeatThatFollowsTheSetpointsWithThem) {
  CurrentAmplifierOptions options = shippedOptions();
  options.enable_address.reset();
  ScriptedTransport bus;
  bus.open();
  const auto requests = [&](int heartbeat_address, Heartbeat heartbeat) {
    options.heartbeat_address = heartbeat_address;
    CurrentAmplifier amplifier(options, 24, bus);
    const std::size_t before = bus.writes().size();
    amplifier.write(Eigen::VectorXd::Constant(24, 0.5), OutputStages::kOn, heartbeat);
    EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 23), 500);
    return bus.writes().size() - before;
  };
  EXPECT_EQ(requests(101, Heartbeat::kGiven), 2U);
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 24), 0);
  EXPECT_EQ(requests(24, Heartbeat::kWithheld), 1U);
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 24), 0);
  EXPECT_EQ(requests(24, Heartbeat::kGiven), 1U);
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 24), 1);
}

TEST(CurrentAmplifier, WritesAHeartbeatThatNoRequestHoldsBesideTheSetpoints) {
  CurrentAmplifierOptions options = shippedOptions();
  options.enable_address.reset();
  options.tripped.reset();
  options.heartbeat_address = 123;
  ScriptedTransport bus;
  bus.open();
  CurrentAmplifier amplifier(options, 123, bus);
  amplifier.write(Eigen::VectorXd::Zero(123), OutputStages::kOn);
  EXPECT_EQ(bus.writes().size(), 2U);
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 123), 1);
}

/// The amplifier of the second example: all in holding registers.
CurrentAmplifierOptions inOneRequest() {
  CurrentAmplifierOptions options = shippedOptions();
  options.heartbeat_address = 24;
  options.enable_address = 25;
  options.currents.table = RegisterTable::kHolding;
  options.currents.address = 100;
  options.tripped->table = RegisterTable::kHolding;
  options.tripped->address = 124;
  options.one_request = true;
  return options;
}

TEST(CurrentAmplifier, ReadsATripThatIsNextToTheCurrentsWithThem) {
  CurrentAmplifierOptions options = shippedOptions();
  ScriptedTransport bus;
  bus.open();
  const auto reads_at = [&](RegisterTable table, int address, int unit) {
    options.tripped->table = table;
    options.tripped->address = address;
    options.tripped->unit = unit;
    CurrentAmplifier amplifier(options, 24, bus);
    amplifier.write(Eigen::VectorXd::Zero(24), OutputStages::kOn);
    bus.set(kUnit, RegisterTable::kInput, 3, {1250});
    bus.set(unit, table, address, {1});
    const int before = bus.reads();
    const bool has_asked = !amplifier.tellsTripsByReadings() && amplifier.isTripped();
    const AmplifierReading reading = amplifier.read();
    EXPECT_NEAR(reading.currents[3], 1.25, 1e-12);
    EXPECT_NE(has_asked, reading.tripped);
    bus.set(unit, table, address, {0});
    EXPECT_FALSE(amplifier.read().tripped);
    return bus.reads() - before - 1;
  };
  EXPECT_EQ(reads_at(RegisterTable::kInput, 24, kUnit), 1);
  EXPECT_EQ(reads_at(RegisterTable::kInput, 32, kUnit), 1);
  // A device need not have the registers between.
  EXPECT_EQ(reads_at(RegisterTable::kInput, 33, kUnit), 2);
  EXPECT_EQ(reads_at(RegisterTable::kHolding, 30, kUnit), 2);
  EXPECT_EQ(reads_at(RegisterTable::kInput, 24, kUnit + 1), 2);
}

// It must be known before they are switched on.
TEST(CurrentAmplifier, IsAskedForATripWhileItsStagesAreOff) {
  ScriptedTransport bus;
  bus.open();
  CurrentAmplifier amplifier(inOneRequest(), 24, bus);
  EXPECT_FALSE(amplifier.tellsTripsByReadings());
  amplifier.write(Eigen::VectorXd::Zero(24), OutputStages::kOff);
  EXPECT_FALSE(amplifier.tellsTripsByReadings());
  amplifier.write(Eigen::VectorXd::Zero(24), OutputStages::kOn);
  EXPECT_TRUE(amplifier.tellsTripsByReadings());
  amplifier.switchOff();
  EXPECT_FALSE(amplifier.tellsTripsByReadings());
}

TEST(CurrentAmplifier, ExchangesAllByOneRequestWhereThatIsAskedFor) {
  ScriptedTransport bus;
  bus.open();
  CurrentAmplifier amplifier(inOneRequest(), 24, bus);
  const Eigen::VectorXd currents = Eigen::VectorXd::LinSpaced(24, -1.15, 1.15);
  // The output stages are switched by a request of their own, after the setpoints.
  amplifier.exchange(currents, OutputStages::kOn, Heartbeat::kGiven);
  EXPECT_EQ(bus.exchanges(), 0);
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 25), 1);
  for (int coil = 0; coil < 24; ++coil) {
    bus.set(kUnit, RegisterTable::kHolding, 100 + coil, {static_cast<std::uint16_t>(10 * coil)});
  }
  bus.set(kUnit, RegisterTable::kHolding, 124, {7});
  const std::size_t writes = bus.writes().size();
  const int reads = bus.reads();
  const AmplifierReading reading =
      amplifier.exchange(-currents, OutputStages::kOn, Heartbeat::kGiven);
  EXPECT_EQ(bus.exchanges(), 1);
  EXPECT_EQ(bus.writes().size(), writes + 1);
  EXPECT_EQ(bus.reads(), reads);
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 0), 1150);
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 24), 2);
  EXPECT_LT((reading.currents - Eigen::VectorXd::LinSpaced(24, 0.0, 0.23)).norm(), 1e-12);
  EXPECT_TRUE(reading.tripped);
  amplifier.exchange(currents, OutputStages::kOn, Heartbeat::kWithheld);
  EXPECT_EQ(bus.exchanges(), 2);
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, 24), 2);
}

TEST(CurrentAmplifier, TellsWhyOneRequestCannotHoldAll) {
  using Change = std::function<void(CurrentAmplifierOptions&)>;
  const std::vector<std::pair<Change, std::string>> cases{
      {[](auto&) {}, ""},
      {[](auto& options) { options.tripped.reset(); }, ""},
      {[](auto& options) { options.heartbeat_address.reset(); }, ""},
      {[](auto& options) { options.tripped->address = 224; }, ""},
      {[](auto& options) { options.tripped->address = 225; }, "126 words"},
      {[](auto& options) { options.tripped->address = 50; }, ""},
      {[](auto& options) { options.heartbeat_address = 26; }, "heartbeat_address"},
      {[](auto& options) { options.currents.table = RegisterTable::kInput; }, "currents"},
      {[](auto& options) { options.currents.unit = 3; }, "currents"},
      {[](auto& options) { options.tripped->table = RegisterTable::kInput; }, "tripped"},
  };
  ScriptedTransport bus;
  for (const auto& [change, part] : cases) {
    CurrentAmplifierOptions options = inOneRequest();
    change(options);
    if (part.empty()) {
      EXPECT_NO_THROW(CurrentAmplifier(options, 24, bus));
      continue;
    }
    const std::string refusal =
        errorMessage<ConfigError>([&] { CurrentAmplifier(options, 24, bus); });
    EXPECT_NE(refusal.find("one_request"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(part), std::string::npos) << part << ": " << refusal;
  }
  // 121 words are the most that such a request writes.
  CurrentAmplifierOptions many = inOneRequest();
  many.enable_address.reset();
  many.heartbeat_address = 120;
  many.currents.address = 200;
  many.tripped->address = 320;
  EXPECT_NO_THROW(CurrentAmplifier(many, 120, bus));
  many.heartbeat_address = 121;
  many.tripped->address = 321;
  EXPECT_NE(errorMessage<ConfigError>([&] { CurrentAmplifier(many, 121, bus); }).find("121 words"),
            std::string::npos);
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

TEST(CurrentAmplifier, TheComparisonOfCurrentsCannotBeConfiguredAway) {
  struct Case {
    std::string rate;
    std::string deviation;
    const char* refusal;  ///< part of the sentence; nullptr: it is accepted
  };
  const std::vector<Case> cases{
      {"200.0", "", nullptr},
      {"5000.0", "", nullptr},
      {"20.0", "", nullptr},
      {"200.0", "{tolerance: 0.25, beats: 80}", nullptr},
      {"200.0", "{tolerance: 0.26, beats: 80}", "deviation.tolerance"},
      {"200.0", "{tolerance: 1000.0, beats: 80}", "deviation.tolerance"},
      {"200.0", "{tolerance: 0.0, beats: 80}", "deviation.tolerance"},
      {"200.0", "{tolerance: 0.1, beats: 81}", "deviation.beats"},
      {"200.0", "{tolerance: 0.1, beats: 100000}", "deviation.beats"},
      {"200.0", "{tolerance: 0.1, beats: 0}", "deviation.beats"},
      {"5000.0", "{tolerance: 0.1, beats: 2000}", nullptr},
      {"20.0", "{tolerance: 0.1, beats: 8}", nullptr},
      {"20.0", "{tolerance: 0.1, beats: 9}", "deviation.beats"},
  };
  for (const Case& one : cases) {
    const std::string text =
        "link: {type: tcp, host: h}\n"
        "limits: {coil: 1.0, total: 1.0, slew: 1.0}\n"
        "setpoints: {address: 0, type: int16, scale: 1.0}\n"
        "currents: {address: 0, type: int16, scale: 1.0, table: input}\n"
        "heartbeat_address: 100\nrate: " +
        one.rate + (one.deviation.empty() ? "" : "\ndeviation: " + one.deviation) + "\n";
    if (one.refusal == nullptr) {
      const SupervisorLimits limits =
          readCurrentAmplifierOptions(YamlMap::parse(text, "c.yaml")).supervision;
      EXPECT_LE(limits.deviating_beats, 0.4 * std::stod(one.rate)) << text;
    } else {
      EXPECT_NE(refusalOf(text).find(one.refusal), std::string::npos) << text << refusalOf(text);
    }
  }
  // The tolerance that is the default is too much for small coils.
  EXPECT_NE(refusalOf("link: {type: tcp, host: h}\nlimits: {coil: 0.5, total: 1.0, slew: 1.0}\n")
                .find("deviation.tolerance"),
            std::string::npos);
}

// 24 coils: the setpoints are the registers 0 to 23.
TEST(CurrentAmplifier, RegistersThatOverlapAreRefusedByName) {
  using Change = std::function<void(CurrentAmplifierOptions&)>;
  struct Case {
    Change change;
    std::vector<std::string> names;  ///< in the refusal; none: it is accepted
  };
  const std::vector<Case> cases{
      {[](auto&) {}, {}},
      {[](auto& options) { options.heartbeat_address = 24; }, {}},
      {[](auto& options) { options.heartbeat_address = 5; }, {"heartbeat_address", "setpoints"}},
      {[](auto& options) { options.enable_address = 23; }, {"enable_address", "setpoints"}},
      {[](auto& options) { options.enable_address = options.heartbeat_address; },
       {"enable_address", "heartbeat_address"}},
      {[](auto& options) {
         options.setpoints.type = RegisterType::kInt32;
         options.heartbeat_address = 47;
       },
       {"heartbeat_address", "setpoints"}},
      {[](auto& options) { options.currents.table = RegisterTable::kHolding; },
       {"currents", "setpoints"}},
      {[](auto& options) { options.tripped->address = 3; }, {"tripped", "currents"}},
      {[](auto& options) { options.currents.unit = 3; }, {}},
      {[](auto& options) { options.setpoints.address = 65530; }, {"setpoints", "65535"}},
  };
  ScriptedTransport bus;
  for (const Case& one : cases) {
    CurrentAmplifierOptions options = shippedOptions();
    one.change(options);
    if (one.names.empty()) {
      EXPECT_NO_THROW(CurrentAmplifier(options, 24, bus));
      continue;
    }
    const std::string refusal =
        errorMessage<ConfigError>([&] { CurrentAmplifier(options, 24, bus); });
    for (const std::string& name : one.names) {
      EXPECT_NE(refusal.find(name), std::string::npos) << name << ": " << refusal;
    }
  }
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
