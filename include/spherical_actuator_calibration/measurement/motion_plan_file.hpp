#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/measurement/motion_plan.hpp"

namespace sac {

/// A standard deviation that a motion is expected to give a parameter.
struct ExpectedStddev {
  std::string parameter;  ///< name as in reports
  double stddev = 0.0;    ///< [rad]
};

/// A motion plan as kept in a file.
struct MotionPlanRecord {
  std::string software;  ///< version of this package
  MotionPlan plan;
  std::vector<ExpectedStddev> expected;  ///< may be empty
};

/// Text of a plan file (doc/motion_plans.md). Reading it gives back everything to the last bit.
std::string renderMotionPlan(const MotionPlanRecord& record);

/// Reads the text of a plan file; `name` stands for the file in messages. Throws ConfigError that
/// names file, line and key. Whether the plan fits an actuator is for validate().
MotionPlanRecord parseMotionPlan(const std::string& text, const std::string& name);

}  // namespace sac
