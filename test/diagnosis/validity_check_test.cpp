#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kNoise = 1e-3;  // [rad]

std::vector<Sample> orientations(std::size_t poses, unsigned seed) {
  scenarios::Generator generator(seed);
  const std::vector<Eigen::Vector3d> where = scenarios::randomPoses(poses, 0.3, generator);
  return scenarios::orientationSamples(
      scenarios::paperTruth(), where, kNoise, scenarios::uniformStddev(kNoise), generator);
}

void spoil(Sample& sample) {
  sample.R_stator_rotor = rotationExp({0.02, 0.0, -0.02}) * sample.R_stator_rotor;
}

/// Calibrates from 40 poses, of which so many are far off, and checks 8 with so many.
ValidityCheck checked(std::size_t spoilt_in_use, std::size_t spoilt_held_out) {
  std::vector<Sample> samples = orientations(40, 3);
  for (std::size_t n = 0; n < spoilt_in_use; ++n) {
    spoil(samples[7 * n]);
  }
  CalibrationSession session({scenarios::paperNominal()}, samples, {});
  EXPECT_TRUE(session.run({Cycle::kJoint}).success);
  std::vector<Sample> later = orientations(8, 4);
  for (std::size_t n = 0; n < later.size(); ++n) {
    later[n].id += 1000;
    later[n].validation = true;
    if (n < spoilt_held_out) {
      spoil(later[n]);
    }
    session.add(later[n]);
  }
  return checkValidity(session);
}

TEST(ValidityCheck, ExcusesOutliersThatAreAsRareAsAmongTheSamplesInUse) {
  const ValidityCheck check = checked(4, 1);
  EXPECT_TRUE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("1 outliers"), std::string::npos) << check.message;
}

TEST(ValidityCheck, ExcusesNoneWhereNoneWereInUse) {
  EXPECT_FALSE(checked(0, 1).is_valid);
}

TEST(ValidityCheck, ExcusesNoMoreThanAreUsual) {
  EXPECT_FALSE(checked(4, 4).is_valid);
}

TEST(ValidityCheck, PromisesNothingOfFramesThatWereOffBefore) {
  const ValidityCheck check = checked(0, 0);
  EXPECT_TRUE(check.is_valid) << check.message;
  EXPECT_NE(check.message.find("frames that were off when the unit was calibrated"),
            std::string::npos)
      << check.message;
}

}  // namespace
}  // namespace sac
