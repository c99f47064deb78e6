/// The heartbeat of the amplifier's own watchdog, and what it must not bring back.

#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "support/scripted_transport.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

constexpr std::size_t kCoils = 24;
constexpr int kUnit = 2;
constexpr int kTripped = 100;
constexpr int kHeartbeat = 101;
constexpr double kBeat = 0.005;  // [s]

// It has tripped, and its first coil carries 2 A whatever is set, until its watchdog acts: while it
// is tripped it gets no heartbeat. Later it goes on as it should, but for that coil.
TEST(CoilDriverHeartbeat, AZeroByTheWatchdogDuringATripEndsNoError) {
  const CurrentAmplifierOptions options =
      readCurrentAmplifierOptions(YamlMap::load(SOURCE_DIR "/config/coil_driver.yaml"));
  ScriptedTransport bus;
  CoilDriver driver(options, kCoils, bus);
  double now = 100.0;
  double commanded = 0.1;  // [A]
  const auto beats = [&](double seconds, double current) {
    const auto word = static_cast<std::uint16_t>(current / 1e-3);
    bus.set(kUnit, RegisterTable::kInput, 0, {word});
    CoilDriver::Beat last;
    for (const double end = now + seconds; now < end; now += kBeat) {
      driver.offer({"/operator", now, Eigen::VectorXd::Constant(kCoils, commanded)}, {now, now});
      last = driver.beat(now);
    }
    return last.zero_reason;
  };
  EXPECT_EQ(beats(0.1, 0.0), "");
  commanded = 0.0;
  EXPECT_EQ(beats(0.5, 0.0), "");
  const auto heartbeat = [&] { return bus.at(kUnit, RegisterTable::kHolding, kHeartbeat); };
  bus.set(kUnit, RegisterTable::kInput, kTripped, {1});
  const std::uint16_t last = heartbeat();
  beats(0.25, 2.0);
  EXPECT_NE(driver.supervisor().fault(), "");
  beats(1.0, 0.0);
  bus.set(kUnit, RegisterTable::kInput, kTripped, {0});
  const std::string reason = beats(1.0, 0.0);
  EXPECT_NE(reason.find("coil 1 carries 2.00 A"), std::string::npos) << reason;
  EXPECT_EQ(heartbeat(), last);
}

// It refuses every setpoint and switch, so that its watchdog alone has ended the current: with the
// next heartbeat, of whomever, it would be back.
TEST(CoilDriverHeartbeat, AZeroByTheWatchdogIsNoConfirmationForADriverThatEnds) {
  for (const bool has_switch : {true, false}) {
    CurrentAmplifierOptions options =
        readCurrentAmplifierOptions(YamlMap::load(SOURCE_DIR "/config/coil_driver.yaml"));
    if (!has_switch) {
      options.enable_address.reset();
    }
    ScriptedTransport bus;
    CoilDriver driver(options, kCoils, bus);
    double now = 100.0;
    for (; now < 100.5; now += kBeat) {
      driver.offer({"/operator", now, Eigen::VectorXd::Constant(kCoils, 0.1)}, {now, now});
      driver.beat(now);
    }
    bus.setRefusing(true);
    driver.beat(now);
    std::string reason;
    for (int n = 0; n < 100; ++n, now += kBeat) {
      reason = driver.stop(now);
    }
    EXPECT_NE(reason, "");
    EXPECT_FALSE(driver.supervisor().isZeroConfirmed()) << has_switch;
    bus.setRefusing(false);
    for (int n = 0; n < 100; ++n, now += kBeat) {
      reason = driver.stop(now);
    }
    EXPECT_EQ(reason, "");
    EXPECT_TRUE(driver.supervisor().isZeroConfirmed()) << has_switch;
  }
}

}  // namespace
}  // namespace sac
