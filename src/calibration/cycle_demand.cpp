#include "cycle_demand.hpp"

namespace sac {

CycleDemand demandOf(Cycle cycle, std::size_t poles) {
  switch (cycle) {
    case Cycle::kJoint:
      return {3, 10};  // nine unknowns, three equations a pose
    case Cycle::kPoles:
      // Two unknowns for each pole and for the coil, three equations a torque, of which a good
      // choice of poses tells every pole.
      return {poles + 1, kAdvisedTorquesPerPole * poles};
    case Cycle::kCoil:
      return {1, kAdvisedTorquesPerCoil};
    case Cycle::kMotion:
      return {0, 0};  // it needs no sample
    case Cycle::kRefine:
      break;
  }
  return {poles + 1, kAdvisedTorquesPerPole * poles};
}

}  // namespace sac
