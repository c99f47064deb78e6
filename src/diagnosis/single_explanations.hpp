#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"
#include "wiring_case.hpp"

namespace sac {

/// A cause explains a misfit when it takes away so much of its excess at least.
constexpr double kExplainedShare = 0.8;

/// What explains a misfit of samples by itself: effects of the laboratory, the scale of a joint,
/// the strength of a coil or of a pole. Each is fitted to all samples at once, so that those that
/// tell of it are not dropped as outliers. It is named when the samples tell its value, it differs
/// from none beyond its uncertainty, and the misfit falls; all that explain as well are named
/// together, the most probable first.
std::vector<Diagnosis> singleExplanations(const WiringCase& described,
                                          const CalibrationConfig& config);

}  // namespace sac
