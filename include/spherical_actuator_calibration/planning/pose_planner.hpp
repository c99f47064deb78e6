#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// What a session is planned for.
struct PlanningProblem {
  const CalibrationModel* model = nullptr;
  const std::vector<Sample>* held = nullptr;  ///< measured already; they count
  CalibrationState state;  ///< parameters in force: the models are linearised there
  CycleRequest request{Cycle::kRefine, 0};
  EstimationOptions estimation;
};

/// What the poses of a plan are exchanged for.
enum class PlanCriterion {
  kWorstStddev,  ///< a small largest standard deviation
  kInformation,  ///< a large determinant of the information matrix (D-optimal)
};

/// What a session may be like.
struct PosePlanOptions {
  std::size_t max_poses = 10;
  /// Stop as soon as every parameter is expected to be this good [rad]; 0: use all poses.
  double wanted_stddev = 0.0;
  std::size_t coils_per_pose = 6;  ///< excited in turn at one pose, at most; kRefine only
  double current = 2.0;            ///< of an excited coil [A]
  /// The orientation is measured at every pose. For kRefine only: the joint cycle always measures
  /// it, poles and coils never use it.
  bool tracker_on = true;
  PlanCriterion criterion = PlanCriterion::kWorstStddev;

  std::optional<double> tilt_limit;  ///< of |q₁| and |q₂| [rad]; else the workspace's
  double spin_minimum = -kPi;        ///< of q₃ [rad]
  double spin_maximum = kPi;         ///< of q₃ [rad]
  double minimum_spacing = 0.1;      ///< rotation angle between two poses [rad]
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< joint angles where the way begins [rad]

  /// Expected of the sensors, per component of a mean; joints: zero is exact.
  Eigen::Vector3d joint_stddev = Eigen::Vector3d::Zero();  ///< [rad]
  double orientation_stddev = 5.77e-4;                     ///< [rad]
  double torque_stddev = 2.89e-4;                          ///< [N·m]

  std::size_t candidates = 400;  ///< random poses to choose from
  std::uint64_t seed = 1;        ///< of these poses
};

/// Throws ConfigError that names the option, its value and the allowed range for this problem.
void validate(const PosePlanOptions& options, const PlanningProblem& problem);

/// One pose to measure at, and what to excite there (message PlannedPose).
struct PlannedPose {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles q [rad]
  std::vector<std::size_t> coils;                            ///< in turn; none: orientation only
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

  bool reached_wanted = false;  ///< worst_stddev ≤ wanted_stddev, all observable
  /// Poses for the wanted standard deviation: the number planned where it is reached, else what
  /// the square-root law makes of it; nothing where none is wanted or a parameter is unobservable.
  std::optional<std::size_t> poses_needed;
};

/// Chooses the poses, and the coils to excite at each, that add most to what the cycle will know.
///
/// First, poses that increase the determinant of the information matrix most (with a weak prior),
/// one after the other; then every pose is exchanged as long as that serves the criterion. No pole
/// lies where the curve is uncertain when a coil is excited. An orientation counts once per pose,
/// whatever the number of coils excited there: a tracker's errors hardly change while the rotor
/// rests. The expected standard deviations are those that the cycle itself reports for noise-free
/// samples.
///
/// Throws ConfigError when options or request are not valid.
PosePlan planPoses(const PlanningProblem& problem, const PosePlanOptions& options);

}  // namespace sac
