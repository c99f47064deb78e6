#pragma once

#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// Covariance of the reported values of all parameters in force (CalibrationSession::parameters()),
/// in their units and order, to first order.
Eigen::MatrixXd reportedCovariance(const CalibrationSession& session);

/// Factor on a standard deviation for an interval that holds the truth with a probability of 95 %:
/// of Student's distribution where residuals widened the standard deviations of the last
/// successful cycle, so that they are as uncertain as its degrees of freedom let them be; else of
/// the normal distribution (JCGM 100, G.3).
double coverageFactor(const CalibrationSession& session);

/// A file for those who go on calculating: names, units, values, covariance matrix, coverage factor
/// and degrees of freedom.
std::string renderCovariance(const CalibrationSession& session);

}  // namespace sac
