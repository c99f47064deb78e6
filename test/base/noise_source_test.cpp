#include "spherical_actuator_calibration/base/noise_source.hpp"

#include <array>
#include <cstdint>
#include <set>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/random_purpose.hpp"

namespace sac {
namespace {

constexpr std::array kPurposes = {
    RandomPurpose::kStudyOrientations,
    RandomPurpose::kStudyNoise,
    RandomPurpose::kManufacturingErrors,
    RandomPurpose::kSessionPlan,
    RandomPurpose::kSampleNoise,
    RandomPurpose::kValidationPoses,
    RandomPurpose::kJointNoise,
    RandomPurpose::kTrackerNoise,
    RandomPurpose::kTrackerBadDwells,
    RandomPurpose::kWrenchNoise,
    RandomPurpose::kCurrentNoise,
    RandomPurpose::kJointStream,
    RandomPurpose::kTrackerStream,
    RandomPurpose::kWrenchStream,
    RandomPurpose::kCurrentStream,
    RandomPurpose::kPoseCandidates,
    RandomPurpose::kMotionCandidates,
    RandomPurpose::kMotionRehearsal,
};

/// Does not compile where two purposes share a number, nor where one is missing here (-Wswitch).
constexpr bool isKnown(RandomPurpose purpose) {
  switch (purpose) {
    case RandomPurpose::kStudyOrientations:
    case RandomPurpose::kStudyNoise:
    case RandomPurpose::kManufacturingErrors:
    case RandomPurpose::kSessionPlan:
    case RandomPurpose::kSampleNoise:
    case RandomPurpose::kValidationPoses:
    case RandomPurpose::kJointNoise:
    case RandomPurpose::kTrackerNoise:
    case RandomPurpose::kTrackerBadDwells:
    case RandomPurpose::kWrenchNoise:
    case RandomPurpose::kCurrentNoise:
    case RandomPurpose::kJointStream:
    case RandomPurpose::kTrackerStream:
    case RandomPurpose::kWrenchStream:
    case RandomPurpose::kCurrentStream:
    case RandomPurpose::kPoseCandidates:
    case RandomPurpose::kMotionCandidates:
    case RandomPurpose::kMotionRehearsal:
      return true;
  }
  return false;
}

TEST(NoiseSource, NoTwoPurposesDrawTheSame) {
  std::set<double> drawn;
  for (const RandomPurpose purpose : kPurposes) {
    EXPECT_TRUE(isKnown(purpose));
    drawn.insert(NoiseSource(1, purpose).gaussian(1.0));
  }
  EXPECT_EQ(drawn.size(), kPurposes.size());
}

TEST(NoiseSource, SeedAndPurposeDecideWhatIsDrawn) {
  NoiseSource first(7, RandomPurpose::kJointNoise);
  NoiseSource again(7, RandomPurpose::kJointNoise);
  NoiseSource other(8, RandomPurpose::kJointNoise);
  const Eigen::Vector3d drawn = first.gaussianVector(1.0);
  EXPECT_EQ(again.gaussianVector(1.0), drawn);
  EXPECT_NE(other.gaussianVector(1.0), drawn);
}

}  // namespace
}  // namespace sac
