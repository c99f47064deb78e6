#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "spherical_actuator_calibration/emulation/session_simulator.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"
#include "spherical_actuator_calibration/ros/emulation_node/session_bag_writer.hpp"

namespace sac {

/// What the command line of simulate_recording asks for.
struct SimulateRecordingOptions {
  std::string actuator_path;
  std::string output_path;
  std::string truth_path;                    ///< where the truth is written
  std::optional<std::string> truth_in_path;  ///< a given truth, instead of a drawn one
  SessionPlanOptions plan;
  std::optional<std::string> plan_path;  ///< a planned session, instead of `plan`
  ManufacturingErrors errors;
  SimulationOptions simulation;
  SessionBagOptions bag;
};

/// Reads the command line. Without a value: help was asked for and has been printed to `out`.
/// Throws ConfigError, naming the option, when it cannot be understood.
std::optional<SimulateRecordingOptions> parseSimulateRecordingOptions(int argc,
                                                                      const char* const* argv,
                                                                      std::ostream& out);

}  // namespace sac
