#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/usual_currents.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/calibration/cycle_request.hpp"
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
  CycleRequest request{Cycle::kRefine};
  EstimationOptions estimation;
};

/// What the poses of a plan are exchanged for.
enum class PlanCriterion {
  kWorstStddev,  ///< a small largest standard deviation
  kInformation,  ///< a large determinant of the information matrix (D-optimal)
};

/// What one torque is measured with.
enum class PlanPatterns {
  kSingle,    ///< one coil alone, at +current
  kWeighing,  ///< several coils at once, each at +current or −current; kRefine only, else kSingle
};

/// What a session may be like.
struct PosePlanOptions {
  std::size_t max_poses = 10;
  /// Stop as soon as every parameter is expected to be this good [rad]; 0: use all poses.
  double wanted_stddev = 0.0;
  std::size_t coils_per_pose = 6;  ///< torques measured at one pose, at most; kRefine only
  PlanPatterns patterns = PlanPatterns::kSingle;
  double current = kUsualExcitation;  ///< of an excited coil [A]
  /// Sum of all |currents| of a pattern, at most [A]: as the shipped amplifier's limit. So many
  /// coils as it allows are excited at once; only for kWeighing.
  double total_current = kUsualTotalCurrent;
  /// The orientation is measured at every pose. For kRefine only: the joint cycle always measures
  /// it, poles and coils never use it.
  bool tracker_on = true;
  PlanCriterion criterion = PlanCriterion::kWorstStddev;

  std::optional<double> tilt_limit;  ///< of |q₁| and |q₂| [rad]; else the workspace's
  double spin_minimum = -kPi;        ///< of q₃ [rad]
  double spin_maximum = kPi;         ///< of q₃ [rad]
  double minimum_spacing = 0.1;      ///< rotation angle between two poses [rad]
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< joint angles where the way begins [rad]

  /// Expected of the sensors, per component of a mean; joints: zero is exact. A rotor without
  /// joints has its tracker at every pose, and orientation_stddev instead of joint_stddev: choice
  /// and bound take it for exact, what is expected of the parameters counts it.
  Eigen::Vector3d joint_stddev = Eigen::Vector3d::Zero();  ///< [rad]
  double orientation_stddev = 5.77e-4;                     ///< [rad]
  double torque_stddev = 2.89e-4;                          ///< [N·m]

  std::size_t candidates = 400;  ///< random poses to choose from
  std::uint64_t seed = 1;        ///< of these poses

  /// Asked between steps: once it is true, the best plan so far is returned, and the bound as far
  /// as it is known. Without it, or while it is false, the same options give the same plan.
  std::function<bool()> is_time_up;
};

/// Throws ConfigError that names the option, its value and the allowed range for this problem.
void validate(const PosePlanOptions& options, const PlanningProblem& problem);

/// The options with the standard deviations that samples at hand have (angles [rad], torques
/// [N·m]), instead of those that are expected before anything is measured: the median of the
/// samples, of each kind of reading on its own, held-out ones included. What no sample tells stays
/// as it is. So a plan promises what this machine and this length of capture give.
PosePlanOptions withMeasuredNoise(PosePlanOptions options, const std::vector<Sample>& held);

}  // namespace sac
