#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"

namespace sac {

/// A coil of a pattern, counted from 0, and the way of its current: +1 or −1.
struct SignedCoil {
  std::size_t coil = 0;
  int sign = 1;

  friend bool operator==(const SignedCoil& a, const SignedCoil& b) {
    return a.coil == b.coil && a.sign == b.sign;
  }
};

/// Coils that are excited together for one torque, ascending.
using CoilPattern = std::vector<SignedCoil>;

/// "+1 -4": coil 1 at +current and coil 4 at −current, counted from 1.
std::string patternText(const CoilPattern& pattern);

/// One pose to measure at, and what to excite there (message PlannedPose).
struct PlannedPose {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles q [rad]
  std::vector<std::size_t> coils;     ///< that are excited, ascending; none: orientation only
  std::vector<CoilPattern> patterns;  ///< in turn; none: each of the coils alone

  /// The patterns, also where each coil is alone.
  std::vector<CoilPattern> excitations() const;
};

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

/// Chooses the poses, and the coils to excite at each, that add most to what the cycle will know.
///
/// First, poses that increase the determinant of the information matrix most (with a weak prior),
/// one after the other; then every pose is exchanged as long as that serves the criterion. No pole
/// lies where the curve is uncertain when a coil is excited. With patterns of several coils,
/// patterns and poses are exchanged for the largest standard deviation, whatever the criterion. An
/// orientation counts once per pose, whatever the number of torques measured there: a tracker's
/// errors hardly change while the rotor rests. The expected standard deviations are those that the
/// cycle itself reports for noise-free samples.
///
/// Throws ConfigError when options or request are not valid.
PosePlan planPoses(const PlanningProblem& problem, const PosePlanOptions& options);

}  // namespace sac
