#pragma once

#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/calibration_record.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// The covariance of all coordinates as a description holds it, rounded to nine digits.
CovarianceRecord covarianceRecord(const ParameterSpace& space, const ParameterBelief& belief);

/// Effects that a calibration modelled; none without a record.
EffectSelection effectsOf(const std::optional<CalibrationRecord>& calibration);

/// Covariance of the coordinates of the space around a described actuator: of its record, or of the
/// standard deviations alone, where it has none. Throws ConfigError when the record is of other
/// parameters than the space.
Eigen::MatrixXd coordinateCovariance(const ParameterSpace& space,
                                     const CalibratedDescription& description);

/// The same of the machine alone: zero for effects of the laboratory (registrations, bias of the
/// force/torque sensor), which are no part of what joints and coils do, and without `has_load` for
/// the weight that the rotor carries.
Eigen::MatrixXd machineCovariance(const ParameterSpace& space,
                                  const CalibratedDescription& description,
                                  bool has_load);

}  // namespace sac
