#include "spherical_actuator_calibration/actuator/orientation_map.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/LU>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

TEST(OrientationMap, IsTheGaussianProcessGivenItsPoints) {
  const OrientationMapDescription description = scenarios::orientationMap();
  const OrientationMap map(description);
  const Eigen::Vector3d q(0.05, -0.1, 1.2);
  const auto count = static_cast<Eigen::Index>(description.readings.size());
  for (std::size_t c = 0; c < 3; ++c) {
    Eigen::MatrixXd covariance(count, count);
    Eigen::VectorXd cross(count);
    Eigen::VectorXd values(count);
    const double square = std::pow(description.amplitude[c], 2);
    const auto kernel = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      double exponent = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto joint = static_cast<Eigen::Index>(k);
        exponent += (1.0 - std::cos(a[joint] - b[joint])) / std::pow(description.length[k], 2);
      }
      const double root = std::sqrt(10.0 * exponent);
      return square * (1.0 + root + root * root / 3.0) * std::exp(-root);
    };
    for (Eigen::Index a = 0; a < count; ++a) {
      const Eigen::Vector3d& point = description.readings[static_cast<std::size_t>(a)];
      cross[a] = kernel(q, point);
      values[a] = description.rotations[static_cast<std::size_t>(a)][static_cast<Eigen::Index>(c)];
      for (Eigen::Index b = 0; b < count; ++b) {
        covariance(a, b) = kernel(point, description.readings[static_cast<std::size_t>(b)]);
      }
    }
    covariance.diagonal().array() += std::pow(description.noise[c], 2);
    const Eigen::MatrixXd inverse = covariance.inverse();
    const auto component = static_cast<Eigen::Index>(c);
    EXPECT_NEAR(map.mean(q)[component], cross.dot(inverse * values), 1e-12);
    EXPECT_NEAR(
        map.uncertainty(q).variance[component], square - cross.dot(inverse * cross), 1e-6 * square);
    EXPECT_EQ(map.uncertainty(q).noise[component], std::pow(description.noise[c], 2));
  }
}

// What the tracker adds to a measurement is nowhere the rotor is.
TEST(OrientationMap, LeavesTheTrackersNoiseOutOfTheRotors) {
  OrientationMapDescription description = scenarios::orientationMap();
  description.noise = {1e-4, 3e-4, 5e-4};
  description.tracker_noise = 3.0001e-4;
  const Eigen::Vector3d q(0.05, -0.1, 1.2);
  const OrientationMap::Uncertainty told = OrientationMap(description).uncertainty(q);
  EXPECT_EQ(told.of_rotor[0], told.variance[0]);
  EXPECT_EQ(told.of_rotor[1], told.variance[1]);
  EXPECT_NEAR(told.of_rotor[2] - told.variance[2], 16e-8, 1e-11);
  description.tracker_noise = 0.0;
  const OrientationMap::Uncertainty unknown = OrientationMap(description).uncertainty(q);
  EXPECT_EQ(unknown.of_rotor, Eigen::Vector3d(unknown.variance + unknown.noise));
}

// A length that was found within the points' range says nothing of how far it goes on beyond.
TEST(OrientationMap, FallsBackToTheAxesBeyondTheRangeOfItsPointsHoweverLongItsLengthsAre) {
  OrientationMapDescription description = scenarios::orientationMap();
  description.length = {5.0, 5.0, 5.0};
  double highest = -1.0;
  for (const Eigen::Vector3d& reading : description.readings) {
    highest = std::max(highest, reading[0]);
  }
  const OrientationMap map(description);
  Eigen::Vector3d reading = description.readings.front();
  double last = map.mean(reading).norm();
  ASSERT_GT(last, 1e-5);
  reading[0] = highest + 0.6;
  EXPECT_EQ(map.mean(reading).norm(), 0.0);
  const OrientationMap::Uncertainty beyond = map.uncertainty(reading);
  EXPECT_EQ(beyond.support, 0.0);
  EXPECT_NEAR(beyond.variance[1], std::pow(description.amplitude[1], 2), 1e-15);
  // Without a step on the way.
  last = 0.0;
  for (double q = highest + 0.6; q > highest; q -= 1e-3) {
    reading[0] = q;
    const double now = map.mean(reading).norm();
    EXPECT_LT(std::abs(now - last), 1e-2 * description.amplitude[0]) << q;
    last = now;
  }
  EXPECT_GT(map.uncertainty(reading).support, kLeastMapSupport);
}

TEST(OrientationMap, TellsNothingAwayFromItsPoints) {
  const OrientationMap map(scenarios::orientationMap());
  const Eigen::Vector3d far(3.0, 0.0, 0.0);
  EXPECT_LT(map.mean(far).norm(), 1e-6);
  EXPECT_LT(map.uncertainty(far).support, 0.01);
  EXPECT_NEAR(map.uncertainty(far).variance[0], 1e-6, 1e-8);
  EXPECT_GT(map.uncertainty(scenarios::orientationMap().readings[0]).support, 0.7);
}

TEST(OrientationMap, IsTheSameAfterAWholeTurn) {
  const OrientationMap map(scenarios::orientationMap());
  const Eigen::Vector3d q(0.05, -0.1, 1.2);
  EXPECT_LT((map.mean(q) - map.mean(q + Eigen::Vector3d(0.0, 0.0, 2.0 * std::acos(-1.0)))).norm(),
            1e-12);
}

TEST(OrientationMap, RefusesWhatIsNoMap) {
  const auto refused = [](const std::function<void(OrientationMapDescription&)>& spoil) {
    OrientationMapDescription map = scenarios::orientationMap();
    spoil(map);
    EXPECT_THROW(OrientationMap{map}, ConfigError);
  };
  refused([](auto& map) { map.length[1] = 0.0; });
  refused([](auto& map) { map.amplitude[0] = std::nan(""); });
  refused([](auto& map) { map.noise[2] = -1e-4; });
  refused([](auto& map) { map.readings.pop_back(); });
  refused([](auto& map) { map.rotations[0][0] = std::numeric_limits<double>::infinity(); });
  refused([](auto& map) {
    map.readings.clear();
    map.rotations.clear();
  });
  refused([](auto& map) {
    map.readings.resize(kMostMapPoints + 1, Eigen::Vector3d::Zero());
    map.rotations.resize(kMostMapPoints + 1, Eigen::Vector3d::Zero());
  });
}

/// An actuator with everything that may be identified of its joints.
Actuator corrected() {
  Actuator actuator = scenarios::paperTruth();
  actuator.joints[0].correction = {{1e-3, -2e-3, 0.0}, {1e-3, 2e-3, -1e-3, 5e-4}};
  actuator.joints[2].correction = {{0.0, 0.0, 3e-3}, {0.0, 1e-3, 0.0, -2e-3}};
  actuator.orientation_map = std::make_shared<OrientationMap>(scenarios::orientationMap());
  return actuator;
}

TEST(CorrectedJoints, TurnTheRotorByCorrectedReadingsAndTheMap) {
  const Actuator actuator = corrected();
  const Eigen::Vector3d q(0.2, -0.3, 1.0);
  Eigen::Vector3d angles = q;
  angles[0] += 1e-3 * q[0] - 2e-3 * q[1] + 1e-3 * std::cos(q[0]) + 2e-3 * std::sin(q[0]) -
               1e-3 * std::cos(2.0 * q[0]) + 5e-4 * std::sin(2.0 * q[0]);
  angles[2] += 3e-3 * q[2] + 1e-3 * std::sin(q[2]) - 2e-3 * std::sin(2.0 * q[2]);
  const Eigen::Matrix3d expected =
      rotationExp(actuator.orientation_map->mean(q)) *
      rotorOrientation(jointGeometry(scenarios::paperTruth().joints), angles);
  EXPECT_LT((rotorOrientation(jointGeometry(actuator), q) - expected).norm(), 1e-14);
  const JointLinearization linear = linearizeRotorOrientation(jointGeometry(actuator), q);
  EXPECT_LT((linear.R_stator_rotor - expected).norm(), 1e-14);
}

TEST(CorrectedJoints, AreInvertedAsWell) {
  const JointGeometry joints = jointGeometry(corrected());
  const Eigen::Vector3d q(0.2, -0.3, 1.0);
  const auto found = jointAngles(joints, rotorOrientation(joints, q), Eigen::Vector3d::Zero());
  ASSERT_TRUE(found);
  EXPECT_LT((*found - q).norm(), 1e-10);
}

}  // namespace
}  // namespace sac
