#pragma once

#include <cstdint>
#include <vector>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"

namespace sac {

/// When the orientation tracker measures during a session.
enum class TrackerUse {
  kPosesWithoutCurrent,  ///< at dwells without patterns only, as in the paper
  kEveryPose,
};

/// Noise of the mean values that samples are: standard deviations of a normal distribution. The
/// defaults are those of the paper's uniform noise of ±1 mrad and ±0.5 mN·m.
struct SampleNoise {
  double orientation = 5.7735e-4;  ///< per component [rad]
  double torque = 2.88675e-4;      ///< per component [N·m]
  double joint = 0.0;              ///< per joint [rad]
};

/// Throws ConfigError that names the value and its range.
void validate(const SampleNoise& noise);

/// Samples of a session as the sensors of the actuator `truth` give them, without the streams in
/// between: one per pattern of a dwell, one without current where a dwell has none. They state
/// their noise. Ids count from 1. The seed decides every random number. Throws ConfigError when
/// plan or noise are not valid.
std::vector<Sample> simulateSamples(const Actuator& truth,
                                    const SessionPlan& plan,
                                    TrackerUse tracker,
                                    const SampleNoise& noise,
                                    std::uint64_t seed);

}  // namespace sac
