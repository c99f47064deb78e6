#include "spherical_actuator_calibration/emulation/positioning_fixture.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "emulation/time_step.hpp"
#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

/// Time until the fixture rests at its target [s].
double travelTime(PositioningFixture& fixture) {
  double time = 0.0;
  while (!fixture.isAtRest() && time < 60.0) {
    fixture.advance(kTimeStep);
    time += kTimeStep;
  }
  return time;
}

TEST(PositioningFixture, StandsExactlyAtItsTarget) {
  PositioningFixture fixture({}, Eigen::Vector3d::Zero());
  const Eigen::Vector3d target(0.3, -0.2, 2.5);
  fixture.setTarget(target);
  EXPECT_FALSE(fixture.isAtRest());
  EXPECT_LT(travelTime(fixture), 2.0);
  EXPECT_EQ(fixture.position(), target);
  fixture.advance(1.0);
  EXPECT_EQ(fixture.position(), target);
}

TEST(PositioningFixture, NeverExceedsItsLimits) {
  const FixtureOptions options{1.5, 6.0};
  PositioningFixture fixture(options, Eigen::Vector3d(0.1, 0.2, -3.0));
  fixture.setTarget({-0.4, 0.21, 3.0});
  Eigen::Vector3d position = fixture.position();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (int n = 0; n < 6000; ++n) {
    fixture.advance(kTimeStep);
    const Eigen::Vector3d new_velocity = (fixture.position() - position) / kTimeStep;
    EXPECT_LE(new_velocity.cwiseAbs().maxCoeff(), options.speed * (1.0 + 1e-9));
    // The last step takes what is left of the way.
    EXPECT_LE((new_velocity - velocity).cwiseAbs().maxCoeff(),
              2.5 * options.acceleration * kTimeStep);
    position = fixture.position();
    velocity = new_velocity;
  }
  EXPECT_TRUE(fixture.isAtRest());
}

TEST(PositioningFixture, TakesAsLongAsItsLimitsAsk) {
  const FixtureOptions options{2.0, 20.0};
  PositioningFixture fixture(options, Eigen::Vector3d::Zero());
  fixture.setTarget({0.0, 0.0, 3.0});
  const double expected = 3.0 / options.speed + options.speed / options.acceleration;
  EXPECT_NEAR(travelTime(fixture), expected, 0.05 * expected);
}

TEST(PositioningFixture, ABusyComputerMakesNoDifference) {
  PositioningFixture often({}, Eigen::Vector3d::Zero());
  PositioningFixture seldom({}, Eigen::Vector3d::Zero());
  often.setTarget({0.5, 0.0, 1.0});
  seldom.setTarget({0.5, 0.0, 1.0});
  for (int n = 0; n < 40; ++n) {
    often.advance(0.5 * 0.01);
    often.advance(0.5 * 0.01);
    seldom.advance(0.01);
    EXPECT_LT((often.position() - seldom.position()).norm(), 1e-9);
  }
}

TEST(PositioningFixture, RefusesLimitsThatCannotBe) {
  EXPECT_THROW(PositioningFixture({0.0, 1.0}, Eigen::Vector3d::Zero()), ConfigError);
  EXPECT_THROW(PositioningFixture({1.0, std::nan("")}, Eigen::Vector3d::Zero()), ConfigError);
}

}  // namespace
}  // namespace sac
