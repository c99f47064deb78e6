#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "wiring_case.hpp"

namespace sac {

/// Mistakes of joint sensors: signs, orders, units, scales, indices.
std::vector<Hypothesis> jointHypotheses(const Actuator& actuator,
                                        const ManufacturingTolerance& tolerance);

/// Mistakes of the tracker: inverse, order of the quaternion, frames.
std::vector<Hypothesis> trackerHypotheses();

/// Rotations of tracker and marker that are none of the cube's; they start at the identity.
Hypothesis trackerRotation(double tolerance);
Hypothesis markerRotation(double tolerance);

/// Joint angles and measurements of neighbouring rows that were mixed up, by orientations or
/// torques.
std::vector<Hypothesis> shiftHypotheses(Quantity stream);

/// Misfit of a case's orientations at the nominal joints, as expected within the tolerance: Σ of
/// studentLoss() [nats].
double orientationLoss(const WiringCase& given, const CalibrationConfig& config);
/// Of one orientation alone, by how far it is turned from the expected one.
double orientationLoss(const Eigen::Matrix3d& turn,
                       const Eigen::Vector3d& joint_position,
                       double orientation_stddev,
                       const CalibrationConfig& config);

/// The candidates for the orientations of a case that are worth a fit: singles, and pairs where no
/// single will do.
std::vector<ScreenedCandidate> screenOrientations(const WiringCase& described,
                                                  const CalibrationConfig& config);
std::vector<ScreenedCandidate> screenOrientationPairs(const WiringCase& described,
                                                      const CalibrationConfig& config);

}  // namespace sac
