#include "spherical_actuator_calibration/motion/silent_coils.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/moving_rotor.hpp"

namespace sac {
namespace {

MotionRecording recorded() {
  MovingRotor moving;
  moving.duration = 2.0;
  return noisy(moving.record());
}

TEST(SilentCoils, AreThoseOfWhichNoiseIsRead) {
  MotionRecording recording = recorded();
  EXPECT_TRUE(silentCoils(recording).empty());
  auto& currents = recording.spans.front().currents;
  // Noise of about 1 mA, as it is read of the others.
  for (Eigen::Index n = 0; n < currents.rows(); ++n) {
    currents(n, 4) = n % 3 == 0 ? 1.2e-3F : n % 3 == 1 ? -1.5e-3F : 0.4e-3F;
  }
  currents.matrix().col(7).setZero();
  EXPECT_EQ(silentCoils(recording), (std::vector<std::size_t>{4, 7}));
}

TEST(SilentCoils, AreNotThoseOfLittleCurrent) {
  MotionRecording recording = recorded();
  recording.spans.front().currents.matrix().col(4) *= 0.02F;
  EXPECT_TRUE(silentCoils(recording).empty());
}

TEST(SilentCoils, AreNotAllOfThem) {
  MotionRecording recording = recorded();
  recording.spans.front().currents.matrix().setZero();
  EXPECT_TRUE(silentCoils(recording).empty());
}

TEST(SilentCoils, HaveAxesAndStrengthsOfTheirOwn) {
  EffectSelection effects;
  effects["coil_gains"] = true;
  const ParameterSpace space(scenarios::paperNominal(), effects);
  const std::vector<Eigen::Index> found = coordinatesOfCoils(space, {2});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0], space.coil(2));
  EXPECT_EQ(found[1], space.coil(2) + 1);
  EXPECT_EQ(space.name(found[2]), "coil_3/gain");
}

}  // namespace
}  // namespace sac
