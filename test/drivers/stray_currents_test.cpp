#include "spherical_actuator_calibration/drivers/stray_currents.hpp"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "drivers/current_course.hpp"
#include "drivers/shipped_coil_driver.hpp"

namespace sac {
namespace {

/// When the second of two coils is told to have strays [s].
std::optional<double> strayToldAt(const Course& set, const Course& measured, double end) {
  StrayCurrents strays(2, kTolerance);
  for (double time = 0.0; time < end; time += kBeat) {
    strays.setting(Eigen::Vector2d(1.0, set(time)));
    const auto coil = strays.observe(Eigen::Vector2d(1.0, measured(time)), 50.0 + time);
    if (coil) {
      EXPECT_EQ(*coil, 1U);
      return time;
    }
  }
  return std::nullopt;
}

Course constant(double current) {
  return [current](double) { return current; };
}

/// There for `on`, then gone for `off` [s].
Course pulses(double current, double rest, double on, double off) {
  return [=](double time) { return std::fmod(time, on + off) < on ? current : rest; };
}

TEST(StrayCurrents, PulsesAddUpWhereNothingIsSet) {
  const auto told = strayToldAt(constant(0.0), pulses(2.0, 0.0, 0.02, 0.2), 10.0);
  ASSERT_TRUE(told);
  EXPECT_LT(*told, 3.5);
}

TEST(StrayCurrents, PulsesBeyondWhatIsSetAddUp) {
  const auto told = strayToldAt(constant(0.2), pulses(2.4, 0.2, 0.02, 0.2), 10.0);
  ASSERT_TRUE(told);
  EXPECT_LT(*told, 3.5);
}

// A little is set again and again, and covers what flows beside it.
TEST(StrayCurrents, PulsesBesideSmallPulsesThatAreSetAddUp) {
  const auto told = strayToldAt(pulses(0.16, 0.0, 0.03, 0.22), pulses(2.5, 0.0, 0.01, 0.09), 10.0);
  ASSERT_TRUE(told);
  EXPECT_LT(*told, 3.5);
}

TEST(StrayCurrents, AnOvershootIsNone) {
  const Course steps = [](double time) { return std::fmod(time, 0.2) < 0.1 ? 2.0 : -2.0; };
  const Course beyond = [&](double time) {
    return steps(time) * (std::fmod(time, 0.1) < 0.03 ? 1.15 : 1.0);
  };
  EXPECT_FALSE(strayToldAt(steps, beyond, 60.0));
}

TEST(StrayCurrents, WhatWasSetFlowsForAWhile) {
  const Course set = [](double time) { return time < 1.0 ? 2.0 : 0.3; };
  const Course late = [&](double time) { return set(time - 0.25); };
  EXPECT_FALSE(strayToldAt(set, late, 10.0));
  // Not for ever.
  EXPECT_TRUE(strayToldAt(set, constant(2.0), 2.0));
}

}  // namespace
}  // namespace sac
