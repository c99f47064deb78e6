#include "calibrate_bag_diagnosis.hpp"

#include <algorithm>
#include <iostream>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"
#include "spherical_actuator_calibration/diagnosis/validity_check.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"

namespace sac {
namespace {

/// The effect that models a cause: the strength of one pole or coil is among those of all.
std::string effectOf(const std::string& cause) {
  if (cause == "torque_frame") {
    return effect_name::kTorqueRegistration;
  }
  const std::string family = cause.substr(0, cause.find(':'));
  return family == "pole_gain" || family == "coil_gain" ? family + "s" : cause;
}

bool isOfJointNames(const Diagnosis& diagnosis) {
  return diagnosis.cause.rfind("joint_swap", 0) == 0;
}

void writeRedescribed(const Actuator& actuator,
                      const std::vector<std::string>& beyond_description,
                      const std::string& path,
                      OverwritePolicy policy) {
  if (!beyond_description.empty()) {
    std::cout << "No description can correct " << beyond_description.front()
              << ": follow its diagnosis. " << path << " is not written.\n";
    return;
  }
  CalibratedDescription description;
  description.actuator = actuator;
  saveDescription(path, description, policy);
  std::cout << "Corrected description: " << path << "\n";
}

}  // namespace

std::string diagnosisLines(const std::vector<Diagnosis>& diagnoses) {
  std::string lines;
  for (const Diagnosis& diagnosis : diagnoses) {
    lines += "diagnosis: " + diagnosis.cause + ": " + diagnosis.message + "\n";
  }
  return lines.empty() ? "diagnosis: none\n" : lines;
}

bool printCheck(const CalibrationSession& session) {
  std::vector<Sample> samples = session.samples();
  for (Sample& sample : samples) {
    sample.validation = true;
  }
  const ValidityCheck check = checkValidity(
      CalibrationSession(session.start(), samples, session.config()), CheckedSamples::kAll);
  std::cout
      << "check: " << (check.is_valid ? "valid" : "not valid") << "\n"
      << check.message << "\n"
      << "All samples of the recording count as held out here: a description that was made of "
         "them is judged by what it was fitted to.\n";
  return check.is_valid;
}

void writeCorrection(const CalibrationSession& session,
                     const std::vector<Diagnosis>& diagnoses,
                     const std::string& path,
                     OverwritePolicy policy) {
  const WiringDiagnosis wiring =
      diagnoseWiring(session.start().actuator, session.samples(), session.config());
  if (!wiring.mistakes.empty()) {
    writeRedescribed(wiring.redescribed, wiring.beyond_description, path, policy);
    if (wiring.beyond_description.empty() &&
        std::any_of(wiring.mistakes.begin(), wiring.mistakes.end(), isOfJointNames)) {
      std::cout << "It exchanges names of joints, which act on streams alone: calibrate by it with "
                   "--from streams, for recorded samples keep their order.\n";
    }
    return;
  }
  if (const auto motion = redescribedMotion(session, diagnoses)) {
    writeRedescribed(motion->actuator, motion->beyond_description, path, policy);
    return;
  }
  const std::vector<std::string>& effects = effectNames();
  for (const Diagnosis& diagnosis : diagnoses) {
    const std::string effect = effectOf(diagnosis.cause);
    if (std::find(effects.begin(), effects.end(), effect) != effects.end()) {
      CalibrationConfig config = session.config();
      config.effects[effect] = true;
      writeFileAtomically(path, renderCalibrationConfig(config), policy);
      std::cout << "Configuration that models " << effect << ": " << path << "\n";
      return;
    }
  }
  std::cout << "Nothing to correct: " << path << " is not written.\n";
}

}  // namespace sac
