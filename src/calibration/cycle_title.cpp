#include "spherical_actuator_calibration/calibration/cycle_title.hpp"

#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {

std::string cycleTitle(Cycle cycle, const std::optional<std::size_t>& coil) {
  const std::string number = std::to_string(numberOrZero(coil));
  switch (cycle) {
    case Cycle::kPoles:
      return "Poles with coil " + number;
    case Cycle::kCoil:
      return "Coil " + number;
    case Cycle::kJoint:
    case Cycle::kRefine:
    case Cycle::kMotion:
      break;
  }
  return cyclesTitle(cycle);
}

std::string cyclesTitle(Cycle cycle) {
  switch (cycle) {
    case Cycle::kJoint:
      return "Joint";
    case Cycle::kPoles:
      return "Poles with their coil";
    case Cycle::kCoil:
      return "Single coils";
    case Cycle::kRefine:
      return "Refinement";
    case Cycle::kMotion:
      return "Motion";
  }
  return "";
}

}  // namespace sac
