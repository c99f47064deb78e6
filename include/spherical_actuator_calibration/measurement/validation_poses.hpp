#pragma once

#include <cstddef>
#include <cstdint>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/measurement/pose_to_measure.hpp"

namespace sac {

/// How many poses judge a calibration, and with how many coils, each by itself.
struct ValidationPoseOptions {
  std::size_t poses = 2;
  std::size_t coils_per_pose = 2;
  std::uint64_t seed = 1;  ///< the same poses for the same seed
};

/// Poses drawn evenly, or nearly so where many coils are wanted, within four fifths of the tilt
/// limit, to judge a calibration: not where a plan would look, which samples in use tell of
/// already. At each some coils to excite, those first that were excited least; a coil which no pole
/// is near, as drawn, would judge nothing, so that a pose may have fewer. Throws ConfigError where
/// a number is beyond 1000.
PosesToMeasure drawValidationPoses(const Actuator& nominal, const ValidationPoseOptions& options);

}  // namespace sac
