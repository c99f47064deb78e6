#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Where the coordinates of a space are in one that has more effects.
std::vector<Eigen::Index> placesIn(const ParameterSpace& wide, const ParameterSpace& narrow);

/// What is known of some coordinates at their places, and what `others` knows elsewhere.
ParameterBelief widened(const ParameterBelief& belief,
                        const std::vector<Eigen::Index>& places,
                        ParameterBelief others);

}  // namespace sac
