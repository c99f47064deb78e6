#include "recorded_unit.hpp"

#include "spherical_actuator_calibration/actuator/unit_identity.hpp"
#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {

void requireSameUnit(const std::string& recording,
                     const RecordedUnit& unit,
                     const Actuator& actuator) {
  if (const auto other = otherUnit(actuator, unit.actuator, unit.serial)) {
    throw DataError(recording + ": was recorded with the " + other->kind + " " + other->its +
                    ", but the description is of " + other->own + ".");
  }
}

}  // namespace sac
