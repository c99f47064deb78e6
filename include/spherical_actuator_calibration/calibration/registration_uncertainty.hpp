#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/tracked_pose.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"

namespace sac {

/// How well the registrations are known: standard deviation of each component of their rotation
/// [rad]; 0: exact; nothing: not stated, which counts as exact and is told.
struct RegistrationUncertainty {
  std::optional<double> stator_tracker;
  std::optional<double> rotor_marker;
  std::optional<double> rotor_ft_sensor;
  /// Instead of the first two: covariance of small turns of both, which err together, as
  /// FrameRegistration has it.
  std::optional<FrameCovariance> tracker_and_marker = std::nullopt;
};

/// What is stated, as a YAML map in one line [rad, rad²]; "{}" where nothing is. The same words for
/// the same numbers.
std::string inWords(const RegistrationUncertainty& registration);

/// Throws ConfigError where something is stated twice.
void validate(const RegistrationUncertainty& registration);

/// Of 36 numbers [rad²], row by row; nothing where they are not symmetric and positive definite.
std::optional<FrameCovariance> frameCovariance(const std::vector<double>& row_by_row);

/// The same back.
std::vector<double> rowByRow(const FrameCovariance& covariance);

/// Enters what is known of the registrations as what is stated of effects.
void stateRegistration(EffectSelection& effects, const RegistrationUncertainty& registration);

}  // namespace sac
