#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "wiring_case.hpp"

namespace sac {

/// What moved while the session was measured: marker, tracker, or the sensor of a joint that
/// slipped; each at the row that the orientations tell best at the joints of coordinates `x`. Those
/// that are worth a fit.
std::vector<ScreenedCandidate> screenMoved(const WiringCase& described,
                                           const Eigen::VectorXd& x,
                                           const CalibrationConfig& config);

/// Readings that the sensor of a joint cannot have meant: angles that repeat within a turn, and a
/// tilt sensor that sits turned about the vertical. Those that explain something.
std::vector<ScreenedCandidate> screenReadings(const WiringCase& described,
                                              const CalibrationConfig& config);

}  // namespace sac
