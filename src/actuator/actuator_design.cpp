#include "spherical_actuator_calibration/actuator/actuator_design.hpp"

#include <cstddef>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

void requireSameCount(const std::string& what, std::size_t nominal, std::size_t truth) {
  if (nominal != truth) {
    throw ConfigError("The truth has " + std::to_string(truth) + " " + what +
                      ", the actuator description " + std::to_string(nominal) + ".");
  }
}

}  // namespace

void requireSameDesign(const Actuator& nominal, const Actuator& truth) {
  if (nominal.has_joints != truth.has_joints) {
    throw ConfigError("Only one of truth and actuator description has joints.");
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    if (nominal.joints[k].name != truth.joints[k].name) {
      throw ConfigError("The truth calls joint " + std::to_string(numberOf(k)) + " \"" +
                        truth.joints[k].name + "\", the actuator description \"" +
                        nominal.joints[k].name + "\".");
    }
  }
  requireSameCount("poles", nominal.poles.size(), truth.poles.size());
  requireSameCount("coils", nominal.coils.size(), truth.coils.size());
  if (nominal.hasTorqueModel() != truth.hasTorqueModel()) {
    throw ConfigError("Only one of truth and actuator description has a torque curve.");
  }
}

}  // namespace sac
