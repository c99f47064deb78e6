#include "sample_places.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

msg::CalibrationSample sampleWith(std::uint32_t id, std::vector<double> current) {
  msg::CalibrationSample sample;
  sample.id = id;
  sample.joint_position[0] = 12.04 * kOneDegree;
  sample.joint_position[1] = -8.1 * kOneDegree;
  sample.current = std::move(current);
  return sample;
}

TEST(SamplePlaces, TellsAnglesInDegreesAndTheCoilsThatCountAsExcited) {
  SamplePlaces places;
  places.receive(sampleWith(4, {0.05, -2.0, 0.1, 0.0}));
  EXPECT_TRUE(places.knows(4));
  EXPECT_EQ(places.angles(4), "+12.0°, −8.1°, +0.0°");
  EXPECT_EQ(places.coils(4, 0.2), "coil 2");
  EXPECT_EQ(places.coils(4, 0.1), "coils 2, 3");
  EXPECT_EQ(places.coils(4, 3.0), "");
}

TEST(SamplePlaces, CountsManyCoils) {
  SamplePlaces places;
  places.receive(sampleWith(1, {1.0, -1.0, 1.0, -1.0}));
  EXPECT_EQ(places.coils(1, 0.1), "4 coils");
}

TEST(SamplePlaces, SaysNothingOfASampleThatItNeverSaw) {
  SamplePlaces places;
  EXPECT_FALSE(places.knows(9));
  EXPECT_EQ(places.angles(9), "");
  EXPECT_EQ(places.coils(9, 0.1), "");
}

TEST(SamplePlaces, TakesTheLaterOfOneNumberAndForgetsTheOldestOfTooMany) {
  SamplePlaces places;
  places.receive(sampleWith(1, {1.0}));
  places.receive(sampleWith(1, {0.0}));
  EXPECT_EQ(places.coils(1, 0.1), "");
  for (std::uint32_t id = 2; id <= SamplePlaces::kMost + 1; ++id) {
    places.receive(sampleWith(id, {}));
  }
  EXPECT_FALSE(places.knows(1));
  EXPECT_TRUE(places.knows(2));
}

}  // namespace
}  // namespace sac
