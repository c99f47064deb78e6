#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"

namespace sac {

/// What the command line of plan_session asks for.
struct PlanSessionOptions {
  std::string actuator_path;
  std::string output_path;
  std::optional<std::string> config_path;
  std::optional<std::string> samples_path;  ///< held already, as a sample file
  std::vector<std::string> bags;            ///< the same, as recordings
  std::string ns = "/actuator";
  CycleRequest cycle{Cycle::kRefine};
  PosePlanOptions plan;
  double time_budget = 0.0;  ///< [s]; 0: none
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
};

/// Reads the command line. Without a value: help was asked for and has been printed to `out`.
/// Throws ConfigError, naming the option, when it cannot be understood.
std::optional<PlanSessionOptions> parsePlanSessionOptions(int argc,
                                                          const char* const* argv,
                                                          std::ostream& out);

}  // namespace sac
