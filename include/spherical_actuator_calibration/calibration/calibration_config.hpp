#pragma once

#include <string>

#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/calibration/map_use.hpp"
#include "spherical_actuator_calibration/calibration/registration_uncertainty.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"

namespace sac {

/// Names of the frames that measurements must be expressed in.
struct MeasurementFrames {
  std::string stator = "stator";  ///< of measured_orientation
  std::string rotor = "rotor";    ///< of measured_torque
};

/// Expected errors over the workspace (1 sigma, 95th percentile) from which on a calibration is
/// only usable; 0: any will do.
struct WantedAccuracy {
  double orientation = 0.0;  ///< [rad]
  double torque = 0.0;       ///< [N·m/A]
};

/// Everything about a calibration that is a matter of choice. The defaults are those of the members
/// and of the shipped config/calibration.yaml.
struct CalibrationConfig {
  MeasurementFrames frames;
  /// Its current_threshold is the one of `estimation` as well.
  SampleBuilderOptions samples;
  EstimationOptions estimation;
  ManufacturingTolerance tolerance;
  /// Laboratory effects that the refinement identifies beside the geometry, and those that
  /// `registration` states (stateRegistration()).
  EffectSelection effects;
  RegistrationUncertainty registration;
  /// Of what axes and corrections leave of the orientations (chooseOrientationMap()).
  MapUse orientation_map = MapUse::kAuto;
  /// Every so manieth sample is held out for validation; 0: none but those recorded so.
  int hold_out_every = 0;
  WantedAccuracy wanted;
};

/// Enters what is known of the registrations, in `effects` as well.
void stateRegistration(CalibrationConfig& config, const RegistrationUncertainty& registration);

/// Throws ConfigError that names the option, its value and the allowed range.
void validate(const CalibrationConfig& config);

/// Reads a configuration file; keys that are absent have their defaults. Throws ConfigError that
/// names file, line and key for anything unknown, repeated, of the wrong type or out of range.
CalibrationConfig loadCalibrationConfig(const std::string& path);
/// The same for text in memory; `name` stands for the file in messages.
CalibrationConfig parseCalibrationConfig(const std::string& text, const std::string& name);

/// The same for a map that may hold further keys: its user reads those, and calls finish(). `name`
/// stands for the file in messages.
CalibrationConfig readCalibrationConfig(const YamlMap& map, const std::string& name);

/// Options that tell how streams become samples (sections dwell, currents, means, streams) and
/// differ from their defaults, as "dwell.rest_window". They have no effect on samples that were
/// recorded.
std::vector<std::string> changedStreamOptions(const CalibrationConfig& config);

/// Text of a configuration file with every key. Loading gives back the configuration to the last
/// bit.
std::string renderCalibrationConfig(const CalibrationConfig& config);

}  // namespace sac
