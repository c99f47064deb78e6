#include "spherical_actuator_calibration/control/orientation_reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "control/control_cycle.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

Stamp stampOf(double seconds) {
  return static_cast<Stamp>(std::llround(seconds / kSecondsPerTick));
}

double angleBetween(const Eigen::Matrix3d& one, const Eigen::Matrix3d& other) {
  return rotationLog(one.transpose() * other).norm();
}

TEST(OrientationReference, GoesToATargetWithinItsLimitsAndStaysThere) {
  const OrientationReferenceOptions options;
  OrientationReference reference(options);
  reference.reset(Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d target = rotationExp({0.4, -0.3, 1.5});
  reference.setTarget(stampOf(0.0), target);
  double largest_rate = 0.0;
  double largest_acceleration = 0.0;
  for (int n = 1; n <= 4000; ++n) {
    const DesiredMotion& motion = reference.advance(stampOf(n * kStep), kStep);
    largest_rate = std::max(largest_rate, motion.angular_velocity.norm());
    largest_acceleration = std::max(largest_acceleration, motion.angular_acceleration.norm());
  }
  EXPECT_LT(angleBetween(reference.motion().R_stator_rotor, target), 1e-6);
  EXPECT_LT(reference.motion().angular_velocity.norm(), 1e-5);
  EXPECT_GT(largest_rate, 0.9 * options.largest_rate);
  EXPECT_LE(largest_rate, 1.001 * options.largest_rate);
  EXPECT_LE(largest_acceleration, 1.001 * options.largest_acceleration);
}

TEST(OrientationReference, FollowsAStreamWithoutLag) {
  OrientationReference reference({});
  reference.reset(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d velocity(0.2, -0.1, 0.3);
  double error = 0.0;
  for (int n = 1; n <= 4000; ++n) {
    const double time = n * kStep;
    constexpr int kCyclesPerTarget = 20;
    if (n % kCyclesPerTarget == 1) {
      reference.setTarget(stampOf(time), rotationExp(time * velocity));
    }
    const DesiredMotion& motion = reference.advance(stampOf(time), kStep);
    if (time > 2.0) {
      error = std::max(error, angleBetween(motion.R_stator_rotor, rotationExp(time * velocity)));
      EXPECT_LT((motion.angular_velocity - velocity).norm(), 1e-3);
    }
  }
  EXPECT_LT(error, 1e-4);
}

TEST(OrientationReference, ComesToRestWhenTheStreamEnds) {
  OrientationReference reference({});
  reference.reset(Eigen::Matrix3d::Identity());
  double farthest = 0.0;
  for (int n = 0; n < 3000; ++n) {
    const double time = n * kStep;
    if (n < 1000 && n % 10 == 0) {
      reference.setTarget(stampOf(time), rotationExp({0.3 * time, 0.0, 0.0}));
    }
    reference.advance(stampOf(time), kStep);
    farthest = std::max(farthest, rotationLog(reference.motion().R_stator_rotor).x());
  }
  EXPECT_LT(reference.motion().angular_velocity.norm(), 1e-6);
  EXPECT_NEAR(rotationLog(reference.motion().R_stator_rotor).x(), 0.3 * 0.99, 1e-6);
  // A critically damped filter that is stopped at 0.3 rad/s runs out by 0.3 / (12 e) rad.
  EXPECT_LT(farthest, 0.3 + 0.010);
}

TEST(OrientationReference, TargetsThatFollowTooFastArePlacesToGoTo) {
  const OrientationReferenceOptions options;
  OrientationReference reference(options);
  reference.reset(Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d target = rotationExp({0.0, 0.3, 0.0});
  reference.setTarget(0, Eigen::Matrix3d::Identity());
  reference.setTarget(1000, target);
  double fastest = 0.0;
  for (int n = 1; n <= 3000; ++n) {
    fastest =
        std::max(fastest, reference.advance(stampOf(n * kStep), kStep).angular_velocity.norm());
  }
  EXPECT_LE(fastest, 1.001 * options.largest_rate);
  EXPECT_LT(angleBetween(reference.motion().R_stator_rotor, target), 1e-6);
}

TEST(OrientationReference, TurnedAsideItReturnsSmoothly) {
  OrientationReference reference({});
  reference.reset(Eigen::Matrix3d::Identity());
  reference.setTarget(0, Eigen::Matrix3d::Identity());
  reference.turnReference(rotationExp({0.0, 0.05, 0.0}));
  const DesiredMotion& first = reference.advance(stampOf(kStep), kStep);
  EXPECT_NEAR(rotationLog(first.R_stator_rotor).y(), 0.05, 1e-4);
  EXPECT_LT(first.angular_acceleration.norm(), 1e-3);
  for (int n = 2; n < 3000; ++n) {
    reference.advance(stampOf(n * kStep), kStep);
  }
  EXPECT_LT(rotationLog(reference.motion().R_stator_rotor).norm(), 1e-6);
}

TEST(OrientationReference, NamesTheOptionThatIsWrong) {
  OrientationReferenceOptions options;
  options.largest_rate = std::numeric_limits<double>::quiet_NaN();
  try {
    OrientationReference reference(options);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("largest_rate"), std::string::npos);
  }
}

}  // namespace
}  // namespace sac
