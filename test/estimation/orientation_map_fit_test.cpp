#include "spherical_actuator_calibration/estimation/orientation_map_fit.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace sac {
namespace {

/// Poses of a rotor that bends smoothly, is rough by `rough` beside that, and is seen by a tracker.
UnexplainedRotations bentMachine(double rough, double tracker, double stated, int repeats = 1) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> angle(-0.6, 0.6);
  const auto noise = [&](double stddev) {
    return Eigen::Vector3d(
        stddev * normal(generator), stddev * normal(generator), stddev * normal(generator));
  };
  UnexplainedRotations poses;
  for (int n = 0; n < 140; ++n) {
    const Eigen::Vector3d q(angle(generator), angle(generator), 2.0 * angle(generator));
    const Eigen::Vector3d bent(std::sin(3.0 * q[0]), std::cos(2.0 * q[1]), std::sin(2.0 * q[2]));
    const Eigen::Vector3d there = 1e-3 * bent + noise(rough);
    for (int k = 0; k < repeats; ++k) {
      poses.readings.push_back(q);
      poses.rotations.push_back(there + noise(tracker));
      poses.tracker_variances.push_back(stated * stated);
    }
  }
  return poses;
}

/// The rotor's own part of the noise, root mean square [rad].
double roughness(const UnexplainedRotations& poses) {
  const OrientationMap map(fitOrientationMap(mergedPoses(poses)).map);
  const OrientationMap::Uncertainty told = map.uncertainty(poses.readings.front());
  return std::sqrt((told.of_rotor - told.variance).mean());
}

TEST(OrientationMapFit, KeepsTheTrackersNoiseApartFromTheRotors) {
  EXPECT_NEAR(roughness(bentMachine(3e-4, 4e-4, 4e-4)), 3e-4, 0.6e-4);
  EXPECT_LT(roughness(bentMachine(0.0, 4e-4, 4e-4)), 1.5e-4);
}

TEST(OrientationMapFit, CountsTheTrackersNoiseOfAMeanOnce) {
  const UnexplainedRotations merged = mergedPoses(bentMachine(3e-4, 4e-4, 4e-4, 4));
  ASSERT_EQ(merged.tracker_variances.size(), 140u);
  EXPECT_NEAR(merged.tracker_variances.front(), 4e-8, 1e-20);
  EXPECT_NEAR(fitOrientationMap(merged).map.tracker_noise, 2e-4, 1e-12);
}

TEST(OrientationMapFit, DoesNotBelieveANoiseThatThePosesContradict) {
  EXPECT_EQ(fitOrientationMap(bentMachine(0.0, 2e-4, 5e-4)).map.tracker_noise, 0.0);
  EXPECT_NEAR(roughness(bentMachine(0.0, 2e-4, 5e-4)), 2e-4, 0.4e-4);
}

TEST(OrientationMapFit, KnowsNothingOfATrackerThatStatesNothing) {
  UnexplainedRotations poses = bentMachine(3e-4, 4e-4, 4e-4);
  poses.tracker_variances.clear();
  EXPECT_EQ(fitOrientationMap(poses).map.tracker_noise, 0.0);
}

}  // namespace
}  // namespace sac
