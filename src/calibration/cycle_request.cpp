#include "spherical_actuator_calibration/calibration/cycle_request.hpp"

namespace sac {

std::string cycleName(Cycle cycle) {
  switch (cycle) {
    case Cycle::kJoint:
      return "joint";
    case Cycle::kPoles:
      return "poles";
    case Cycle::kCoil:
      return "coil";
    case Cycle::kMotion:
      return "motion";
    case Cycle::kRefine:
      break;
  }
  return "refine";
}

}  // namespace sac
