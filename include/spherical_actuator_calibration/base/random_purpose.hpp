#pragma once

#include <cstdint>

namespace sac {

/// What random numbers are drawn for: with the seed, the number decides all of them (NoiseSource).
/// Every purpose of the package stands here, so that no two share their numbers. A value is never
/// changed: emulated recordings and plans of a seed would become others.
enum class RandomPurpose : std::uint32_t {
  kStudyOrientations = 1,
  kStudyNoise = 2,
  kManufacturingErrors = 100,
  kSessionPlan = 200,
  kSampleNoise = 210,
  kValidationPoses = 220,
  kJointNoise = 300,
  kTrackerNoise = 301,
  kTrackerBadDwells = 302,
  kWrenchNoise = 303,
  kCurrentNoise = 304,
  kJointStream = 400,
  kTrackerStream = 401,
  kWrenchStream = 402,
  kCurrentStream = 403,
  kPoseCandidates = 500,
  kMotionCandidates = 510,
  kMotionRehearsal = 511,
};

}  // namespace sac
