#pragma once

#include <string>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// Factor on a standard deviation for an interval that holds the truth with a probability of 95 %:
/// of Student's distribution where residuals widened the standard deviations of the last
/// successful cycle, so that they are as uncertain as its degrees of freedom let them be; else of
/// the normal distribution (JCGM 100, G.3).
double coverageFactor(const CalibrationSession& session);

/// Of the residuals of the last successful cycle; 0 without one.
int degreesOfFreedom(const CalibrationSession& session);

/// A file for those who go on calculating: names, units, values, covariance matrix, coverage
/// factor, degrees of freedom and uncertainty budget.
std::string renderCovariance(const CalibrationSession& session);

}  // namespace sac
