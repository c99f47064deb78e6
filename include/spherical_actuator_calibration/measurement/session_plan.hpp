#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/usual_currents.hpp"

namespace sac {

/// One pose at rest and what is excited there.
struct PlannedDwell {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles q [rad]
  std::vector<Eigen::VectorXd> patterns;  ///< coil currents, in turn [A]; none: orientation only
  bool validation = false;                ///< meant for checking a calibration, not for making it
};

/// The dwells of one calibration session, in order.
struct SessionPlan {
  std::vector<PlannedDwell> dwells;
};

/// How a session after the paper's protocol is laid out.
struct SessionPlanOptions {
  std::size_t joint_poses = 10;       ///< orientation only, for level 1
  std::size_t main_coil = 0;          ///< the coil of situation 1, counted from 0
  std::size_t main_coil_poses = 30;   ///< with the main coil excited (situation 1)
  std::size_t coil_poses = 4;         ///< with each other coil excited (situation 2)
  std::size_t coils_per_dwell = 4;    ///< most coils excited in turn at one pose of situation 2
  std::size_t validation_poses = 5;   ///< at the end, with several coils excited at once
  double current = kUsualExcitation;  ///< of an excited coil [A]
  double joint_tilt_share = 0.9;      ///< of the tilt limit, used by joint and validation poses
  double torque_tilt_share = 0.5;     ///< of the tilt limit, used by torque poses
};

/// Throws ConfigError that names the option, its value and the allowed range for this actuator.
void validate(const SessionPlanOptions& options, const Actuator& nominal);

/// Plans a session from the nominal description. Poses are random: joints 1 and 2 uniform within
/// the tilt, joint 3 within ±π. Torque poses are drawn until the coil has the wanted pole (each in
/// turn for the main coil, any for the others) where the curve is steep and certain, between twice
/// its blend angle and 0.85 times the begin of its support, and no pole where the curve is
/// uncertain (doc/method.md, Torque curve); if bounded trying finds none, the best pose drawn
/// serves. Without a torque model only the joint poses are planned.
SessionPlan planSession(const Actuator& nominal,
                        const SessionPlanOptions& options,
                        std::uint64_t seed);

/// Throws ConfigError, naming the dwell, when a plan holds no dwells, values that are not finite or
/// patterns that have not one current per coil.
void validate(const SessionPlan& plan, std::size_t coils);

}  // namespace sac
