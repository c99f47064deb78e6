#include <chrono>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "support/scripted_transport.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSlow = 0.02;  // [s]
constexpr int kCurrents = 0;    // address

CurrentAmplifierOptions shippedOptions() {
  return readCurrentAmplifierOptions(YamlMap::load(SOURCE_DIR "/config/coil_driver.yaml"));
}

// Stamps of measured currents follow from it: what else the beat asks for must not shift them.
TEST(CoilDriverReading, KnowsWhenItWas) {
  constexpr int kTrip = 100;
  ScriptedTransport bus;
  CoilDriver driver(shippedOptions(), 24, bus);
  driver.beat(100.0);
  bus.setSlow(kCurrents, kSlow);
  const Clock::time_point begin = Clock::now();
  const double slow_reading = driver.beat(100.005).measured_at - 100.005;
  const std::chrono::duration<double> beat = Clock::now() - begin;
  EXPECT_GE(slow_reading, 0.5 * kSlow);
  EXPECT_LE(slow_reading, beat.count() - 0.5 * kSlow);
  bus.setSlow(kTrip, kSlow);
  const Clock::time_point second = Clock::now();
  const double after_the_trip = driver.beat(100.01).measured_at - 100.01;
  const std::chrono::duration<double> whole = Clock::now() - second;
  EXPECT_GE(after_the_trip, kSlow);
  EXPECT_LE(after_the_trip, whole.count());
}

// Stamps of setpoints follow from it.
TEST(CoilDriverReading, KnowsWhenItHasSet) {
  ScriptedTransport bus;
  CoilDriver driver(shippedOptions(), 24, bus);
  driver.beat(100.0);
  bus.setSlow(kCurrents, kSlow);
  const Clock::time_point begin = Clock::now();
  const CoilDriver::Beat beat = driver.beat(100.005);
  const std::chrono::duration<double> whole = Clock::now() - begin;
  ASSERT_TRUE(beat.set_at.has_value());
  EXPECT_GE(*beat.set_at, 100.005);
  EXPECT_LE(*beat.set_at, 100.005 + whole.count() - kSlow);
  EXPECT_LT(*beat.set_at, beat.measured_at);
}

}  // namespace
}  // namespace sac
