#include "spherical_actuator_calibration/streams/reading_steps.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "quantization.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

constexpr double kTwelveBits = 2.0 * kPi / 4096.0;

double quantized(double angle, double step) {
  return std::round(angle / step) * step;
}

TEST(ReadingSteps, OfAnEncoderAreItsResolution) {
  ReadingSteps steps;
  for (int n = 0; n < 1000; ++n) {
    steps.add(quantized(0.7 * std::sin(0.01 * n), kTwelveBits));
  }
  EXPECT_NEAR(steps.step(), kTwelveBits, 1e-12);
}

TEST(ReadingSteps, SurviveNumbersOf32Bits) {
  ReadingSteps steps;
  for (int n = 0; n < 1000; ++n) {
    steps.add(static_cast<float>(3.0 + quantized(0.7 * std::sin(0.01 * n), kTwelveBits)));
  }
  EXPECT_NEAR(steps.step(), kTwelveBits, 1e-6);
}

TEST(ReadingSteps, NoiseLeavesNone) {
  ReadingSteps steps;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise(0.0, 1e-4);
  for (int n = 0; n < 100; ++n) {
    steps.add(noise(generator));
  }
  EXPECT_EQ(steps.step(), 0.0);
}

TEST(ReadingSteps, JumpsBetweenPosesAreNoSteps) {
  ReadingSteps steps;
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> pose(-3.0, 3.0);
  for (int n = 0; n < 30; ++n) {
    const double angle = pose(generator);
    for (int repeated = 0; repeated < 10; ++repeated) {
      steps.add(angle);
    }
    EXPECT_EQ(steps.step(), 0.0);
  }
}

/// Root mean square error of means of readings at random places, with and without noise.
double measuredError(double noise_in_steps) {
  constexpr int kPlaces = 4000;
  constexpr int kReadings = 2000;
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  std::normal_distribution<double> noise(0.0, noise_in_steps);
  double squares = 0.0;
  for (int n = 0; n < kPlaces; ++n) {
    const double truth = place(generator);
    double sum = 0.0;
    for (int k = 0; k < kReadings; ++k) {
      sum += std::round(truth + (noise_in_steps > 0.0 ? noise(generator) : 0.0));
    }
    squares += std::pow(sum / kReadings - truth, 2);
  }
  return std::sqrt(squares / kPlaces);
}

TEST(QuantizationVariance, IsThatOfMeansOfManyReadings) {
  EXPECT_NEAR(std::sqrt(quantizationVariance(1.0, 0.0)), measuredError(0.0), 0.005);
  EXPECT_NEAR(std::sqrt(quantizationVariance(1.0, 0.0)), std::sqrt(1.0 / 12.0), 1e-3);
  // With noise, single readings vary by it and by the steps.
  constexpr double kNoise = 0.25;
  EXPECT_NEAR(std::sqrt(quantizationVariance(1.0, kNoise * kNoise + 1.0 / 12.0)),
              measuredError(kNoise),
              0.01);
  EXPECT_LT(quantizationVariance(1.0, 1.0), 1e-12);
  EXPECT_EQ(quantizationVariance(0.0, 1.0), 0.0);
}

}  // namespace
}  // namespace sac
