#include "spherical_actuator_calibration/planning/sample_places.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

namespace sac {
namespace {

Sample sampleAt(double q, bool validation = false) {
  Sample sample;
  sample.joint_position = Eigen::Vector3d(0.1, q, -q);
  sample.validation = validation;
  return sample;
}

TEST(SamplePlaces, AreToldApartByTheirFirstSamples) {
  constexpr double kStep = 0.6 * kPoseTolerance;
  SamplePlaces places;
  EXPECT_EQ(places.placeOf(sampleAt(0.0)), 0U);
  EXPECT_EQ(places.placeOf(sampleAt(kStep)), 0U);
  EXPECT_EQ(places.placeOf(sampleAt(2.0 * kStep)), 1U);  // near the second, not the first
  EXPECT_EQ(places.placeOf(sampleAt(2.5 * kStep)), 1U);
  EXPECT_EQ(places.placeOf(sampleAt(kStep)), 0U);  // near both
}

TEST(SamplePlaces, AreOthersWhereSamplesAreHeldOut) {
  SamplePlaces places;
  EXPECT_EQ(places.placeOf(sampleAt(0.0)), 0U);
  EXPECT_EQ(places.placeOf(sampleAt(0.0, true)), 1U);
  EXPECT_EQ(places.placeOf(sampleAt(0.0)), 0U);
}

TEST(SamplePlaces, AreTheSameAFullTurnAway) {
  SamplePlaces places;
  EXPECT_EQ(places.placeOf(sampleAt(3.1)), 0U);
  EXPECT_EQ(places.placeOf(sampleAt(3.1 - 2.0 * kPi)), 0U);
  EXPECT_EQ(places.placeOf(sampleAt(3.1 - 2.0 * kPi + 1.1 * kPoseTolerance)), 1U);
}

}  // namespace
}  // namespace sac
