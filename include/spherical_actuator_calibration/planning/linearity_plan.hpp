#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/measurement/pose_to_measure.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/planning/planned_capture.hpp"

namespace sac {

/// What tells at a pose whether torque is proportional to current (TorqueLinearity): one coil alone
/// at full, half and reversed current, in one rest.
struct LinearityPlan {
  /// So many captures, where the patterns of the pose are measured; 0: it is not to be done there,
  /// as the pose is to judge, excites nothing, or half of the current would not be told from none.
  std::size_t captures = 0;
  /// Those that the last rest at the pose lacks, of the coil that makes most torque there; empty
  /// where no coil was excited there yet.
  std::vector<PlannedCapture> missing;
};

/// `held`: the samples in use; `current` of an excited coil [A]; `current_threshold` [A]: a coil
/// below it counts as off.
LinearityPlan linearityPlan(const std::vector<Sample>& held,
                            const PoseToMeasure& pose,
                            double current,
                            double current_threshold);

}  // namespace sac
