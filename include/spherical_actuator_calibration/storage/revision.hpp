#pragma once

#include <cstdint>
#include <string>

#include "spherical_actuator_calibration/estimation/calibration_state.hpp"

namespace sac {

/// Where the parameters of a revision come from, without the parameters.
struct RevisionSummary {
  std::uint32_t number = 0;  ///< counts from 0, the parameters at the start
  std::string date;          ///< when they came into force: ISO 8601, with time
  std::string software;      ///< version that made them
  std::string source;        ///< nominal, identified or restored (message ActuatorParameters)
  std::string origin;        ///< "start", cycle that made them ("coil:3"), "reset" or "revision 4"
  bool refined = false;      ///< the refinement made them
};

/// Parameters that are or were in force.
struct Revision : RevisionSummary {
  CalibrationState state;
};

}  // namespace sac
