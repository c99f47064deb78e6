#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/planning/planned_pose.hpp"

namespace sac {

/// A session and what it will tell.
struct PosePlan {
  bool success = false;                 ///< poses were found, or none is needed
  std::string message;                  ///< a sentence or two that an operator can act on
  std::vector<PlannedPose> poses;       ///< in the order to be visited
  std::size_t orientation_samples = 0;  ///< planned
  std::size_t torque_samples = 0;       ///< planned
  double travel = 0.0;                  ///< sum over the moves of the largest joint angle [rad]

  /// All parameters that the plan is for, as the cycle will find them with held and planned
  /// samples. One that stays unobservable has the standard deviation of the state.
  std::vector<ParameterEstimate> expected;
  std::string worst_parameter;
  double worst_stddev = 0.0;             ///< largest of `expected` [rad]
  double orientation_uncertainty = 0.0;  ///< see workspace_uncertainty.hpp [rad]
  double torque_uncertainty = 0.0;       ///< [N·m/A]

  /// No plan of as many poses and torques brings the worst standard deviation below this [rad],
  /// with the same limits of currents and workspace. It is proven for poses out of five times as
  /// many random ones as the plan was chosen from; over all poses it may be lower by about 1 %.
  /// Nothing where it is not known: for kSingle, or when time was up before.
  std::optional<double> stddev_bound;

  bool reached_wanted = false;  ///< worst_stddev ≤ wanted_stddev, all observable
  /// Poses for the wanted standard deviation: the number planned where it is reached, else what
  /// the square-root law makes of it; nothing where none is wanted or a parameter is unobservable.
  std::optional<std::size_t> poses_needed;
};

}  // namespace sac
