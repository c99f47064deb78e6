#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// One thing that explains the samples where the wiring as described does not (message Diagnosis).
struct Diagnosis {
  std::string cause;    ///< joint_sign:2, coil_swap:3:7, … as in doc/diagnosis.md; counted from 1
  std::string message;  ///< what is wrong and what to change where, for an operator
  /// Logarithm of the odds by which the samples prefer the corrected wiring [nats].
  double evidence = 0.0;
};

/// Mistakes of wiring, and the samples and description as they are without them.
struct WiringDiagnosis {
  /// Most decisive first. Where several explain the samples equally well they stand one after the
  /// other, and each message names the others.
  std::vector<Diagnosis> mistakes;
  /// Corrected by the first of those that explain equally; as given where nothing is wrong.
  Actuator actuator;
  std::vector<Sample> samples;
  /// The description that fits the samples as they were recorded, as far as a description can hold
  /// the corrections; those it cannot hold are in `beyond_description`, by their causes.
  Actuator redescribed;
  std::vector<std::string> beyond_description;
};

/// Looks for the discrete mistakes that laboratories make: signs, orders, units and frames of
/// sensors, coils and poles (doc/diagnosis.md). Each hypothesis undoes one of them; it is named
/// when the samples, with errors of the size of the manufacturing tolerance, prefer it beyond
/// chance and it explains them. All samples serve, held out or not. Unidentified because too few
/// samples: no mistake. `nominal`: as described.
WiringDiagnosis diagnoseWiring(const Actuator& nominal,
                               const std::vector<Sample>& samples,
                               const CalibrationConfig& config);

/// "joint_sign", …: every cause that a diagnosis of the wiring may name, without numbers.
const std::vector<std::string>& wiringCauses();

}  // namespace sac
