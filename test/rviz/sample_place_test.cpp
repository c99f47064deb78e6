#include "sample_place.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

msg::CalibrationSample sampleWith(std::vector<double> current) {
  msg::CalibrationSample sample;
  sample.joint_position[0] = 12.04 * kOneDegree;
  sample.joint_position[1] = -8.1 * kOneDegree;
  sample.current = std::move(current);
  return sample;
}

TEST(SamplePlace, TellsAnglesInDegreesAndTheCoilsThatCountAsExcited) {
  const msg::CalibrationSample sample = sampleWith({0.05, -2.0, 0.1, 0.0});
  EXPECT_EQ(anglesOf(sample), "+12.0°, −8.1°, +0.0°");
  EXPECT_EQ(coilsOf(sample, 0.2), "coil 2");
  EXPECT_EQ(coilsOf(sample, 0.1), "coils 2, 3");
  EXPECT_EQ(coilsOf(sample, 3.0), "");
}

TEST(SamplePlace, CountsManyCoils) {
  EXPECT_EQ(coilsOf(sampleWith({1.0, -1.0, 1.0, -1.0}), 0.1), "4 coils");
}

}  // namespace
}  // namespace sac
