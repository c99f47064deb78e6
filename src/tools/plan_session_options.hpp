#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/core/atomic_file.hpp"
#include "spherical_actuator_calibration/core/calibration_cycles.hpp"
#include "spherical_actuator_calibration/core/pose_planner.hpp"

namespace spherical_actuator_calibration {

/// What the command line of plan_session asks for.
struct PlanSessionOptions {
  std::string actuator_path;
  std::string output_path;
  std::optional<std::string> config_path;
  std::optional<std::string> samples_path;  ///< held already, as a sample file
  std::vector<std::string> bags;            ///< the same, as recordings
  std::string ns = "/actuator";
  CycleRequest cycle{Cycle::kRefine, 0};
  PosePlanOptions plan;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
};

/// Reads the command line. Without a value: help was asked for and has been printed to `out`.
/// Throws ConfigError, naming the option, when it cannot be understood.
std::optional<PlanSessionOptions> parsePlanSessionOptions(int argc,
                                                          const char* const* argv,
                                                          std::ostream& out);

}  // namespace spherical_actuator_calibration
