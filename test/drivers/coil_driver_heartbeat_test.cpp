/// The heartbeat of the amplifier's own watchdog, and what it must not bring back.

#include <string>

#include <gtest/gtest.h>

#include "drivers/shipped_coil_driver.hpp"
#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "support/scripted_transport.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

constexpr int kTripped = 100;
constexpr int kHeartbeat = 101;

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

/// An amplifier that has a current while its heartbeat is younger than its watchdog, from which on
/// it has none, whatever is set.
class DeafAmplifier {
 public:
  DeafAmplifier(ScriptedTransport& bus, double watchdog) : bus_(bus), watchdog_(watchdog) {}

  /// Measures a moment later, and tells whether there is current.
  bool flowsAt(double time) {
    const std::uint16_t beat = bus_.at(kUnit, RegisterTable::kHolding, kHeartbeat);
    fed_at_ = beat != beat_ ? time : fed_at_;
    beat_ = beat;
    is_on_ = is_on_ && time - fed_at_ < watchdog_;
    bus_.set(kUnit, RegisterTable::kInput, 0, {static_cast<std::uint16_t>(is_on_ ? 1500 : 0)});
    return is_on_;
  }

 private:
  ScriptedTransport& bus_;
  double watchdog_;
  double fed_at_ = 100.0;
  std::uint16_t beat_ = 0;
  bool is_on_ = true;
};

// Its current ends by its watchdog, soon after the driver has set zero: that looks like an
// amplifier with a lag, unless it is fed until it is told.
TEST(CoilDriverHeartbeat, GoesOnAtTheEndUntilAnAmplifierThatKeepsItsCurrentIsTold) {
  for (const double watchdog : {0.25, 0.3, 0.5}) {
    ScriptedTransport bus;
    CoilDriver driver(
        readCurrentAmplifierOptions(YamlMap::load(SOURCE_DIR "/config/coil_driver.yaml")),
        kCoils,
        bus);
    DeafAmplifier amplifier(bus, watchdog);
    Eigen::VectorXd command = Eigen::VectorXd::Zero(kCoils);
    command[0] = 1.5;
    double now = 100.0;
    for (; now < 100.5; now += kBeat) {
      driver.offer({"/operator", now, command}, {now, now});
      driver.beat(now);
      amplifier.flowsAt(now);
    }
    const double begin = now;
    double flowed = 0.0;
    for (; now < begin + 1.0; now += kBeat) {
      driver.stop(now);
      flowed = amplifier.flowsAt(now) ? now - begin : flowed;
    }
    EXPECT_NE(driver.supervisor().fault(), "") << watchdog;
    EXPECT_FALSE(driver.supervisor().isZeroConfirmed()) << watchdog;
    EXPECT_GT(flowed, watchdog);
    EXPECT_LT(flowed, 0.35 + watchdog);
  }
}

// Zero is confirmed, and the program has not ended yet.
TEST(CoilDriverHeartbeat, DoesNotGoOnWhileTheEndIsWatchedAndCurrentIsTold) {
  ScriptedTransport bus;
  CoilDriver driver(
      readCurrentAmplifierOptions(YamlMap::load(SOURCE_DIR "/config/coil_driver.yaml")),
      kCoils,
      bus);
  double now = 100.0;
  driver.beat(now);
  std::string reason = "not confirmed";
  for (; !reason.empty() && now < 102.0; now += kBeat) {
    reason = driver.stop(now);
  }
  ASSERT_EQ(reason, "");
  const std::size_t writes = bus.writes().size();
  EXPECT_EQ(driver.watch(now), "");
  bus.setReachable(false);
  EXPECT_EQ(driver.watch(now + kBeat), "") << "it had no current when it was heard last";
  bus.setReachable(true);
  EXPECT_EQ(driver.watch(now + 2.0 * kBeat), "");
  EXPECT_EQ(bus.writes().size(), writes);
  bus.set(kUnit, RegisterTable::kInput, 0, {1500});
  EXPECT_NE(driver.watch(now + 3.0 * kBeat).find("1.50 A"), std::string::npos);
  EXPECT_GT(bus.writes().size(), writes) << "zero is set again";
  for (std::size_t n = writes; n < bus.writes().size(); ++n) {
    EXPECT_NE(bus.writes()[n].address, kHeartbeat);
  }
}

// A watchdog may have ended the current since the heartbeat was given last, which gives it again.
TEST(CoilDriverHeartbeat, DoesNotComeBackAtTheEnd) {
  ScriptedTransport bus;
  CoilDriver driver(
      readCurrentAmplifierOptions(YamlMap::load(SOURCE_DIR "/config/coil_driver.yaml")),
      kCoils,
      bus);
  double now = 100.0;
  for (; now < 100.5; now += kBeat) {
    driver.offer({"/operator", now, Eigen::VectorXd::Constant(kCoils, 0.1)}, {now, now});
    driver.beat(now);
  }
  bus.setReachable(false);
  driver.beat(now);
  bus.setReachable(true);
  now += 0.3;
  const std::uint16_t last = bus.at(kUnit, RegisterTable::kHolding, kHeartbeat);
  for (const double end = now + 1.0; now < end; now += kBeat) {
    driver.stop(now);
  }
  EXPECT_EQ(driver.stop(now), "");
  EXPECT_EQ(bus.at(kUnit, RegisterTable::kHolding, kHeartbeat), last);
}

}  // namespace
}  // namespace sac
