#include "spherical_actuator_calibration/actuator/unit_identity.hpp"

namespace sac {

std::optional<OtherUnit> otherUnit(const Actuator& actuator,
                                   const std::string& name,
                                   const std::string& serial) {
  if (!name.empty() && name != actuator.name) {
    return OtherUnit{"actuator", name, actuator.name};
  }
  if (!serial.empty() && !actuator.serial.empty() && serial != actuator.serial) {
    return OtherUnit{"unit", serial, actuator.serial};
  }
  return std::nullopt;
}

}  // namespace sac
