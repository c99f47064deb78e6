#include "evidence.hpp"

namespace sac {

Evidence evidenceOf(const Actuator& nominal, const std::vector<Sample>& samples) {
  Evidence evidence;
  for (const Sample& sample : samples) {
    // Without joints nothing but torques contradicts the tracker.
    evidence.orientations += nominal.has_joints && sample.has_orientation ? 1U : 0U;
    evidence.torques += nominal.hasTorqueModel() && sample.has_torque ? 1U : 0U;
  }
  return evidence;
}

std::string whyNothingIsTold(const Actuator& nominal, const std::vector<Sample>& samples) {
  const Evidence evidence = evidenceOf(nominal, samples);
  if (evidence.orientations >= kFewestOrientations || evidence.torques >= kFewestTorques) {
    return "";
  }
  return "Nothing can be told: " + std::to_string(evidence.orientations) + " orientations and " +
         std::to_string(evidence.torques) + " torques are there, and a mistake shows from " +
         std::to_string(kFewestOrientations) + " orientations or " +
         std::to_string(kFewestTorques) + " torques on.";
}

}  // namespace sac
