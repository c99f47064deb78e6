#include <chrono>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "support/scripted_transport.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

// Stamps of measured currents follow from it: what else the beat asks for must not shift them.
TEST(CoilDriverReading, KnowsHowLongItTook) {
  constexpr double kSlow = 0.02;
  constexpr int kCurrents = 0;
  constexpr int kTrip = 100;
  using Clock = std::chrono::steady_clock;
  ScriptedTransport bus;
  CoilDriver driver(
      readCurrentAmplifierOptions(YamlMap::load(SOURCE_DIR "/config/coil_driver.yaml")), 24, bus);
  driver.beat(100.0);
  bus.setSlow(kCurrents, kSlow);
  EXPECT_GE(driver.beat(100.005).reading_time, kSlow);
  bus.setSlow(kTrip, kSlow);
  const Clock::time_point begin = Clock::now();
  const double reading_time = driver.beat(100.01).reading_time;
  const std::chrono::duration<double> whole = Clock::now() - begin;
  EXPECT_LE(reading_time, whole.count() - kSlow);
  EXPECT_GE(reading_time, 0.0);
}

}  // namespace
}  // namespace sac
