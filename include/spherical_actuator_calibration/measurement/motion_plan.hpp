#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/usual_currents.hpp"

namespace sac {

/// amplitude · sin(2π · frequency · t + phase).
struct Sine {
  double frequency = 1.0;  ///< [Hz]
  double amplitude = 0.0;  ///< of a joint [rad], of a coil [A]
  double phase = 0.0;      ///< [rad]
};

/// A sum of sines at a time [s].
double valueOf(const std::vector<Sine>& sines, double time);
/// What the absolute values of it and of its rate of change never exceed.
double largestValueOf(const std::vector<Sine>& sines);
double largestRateOf(const std::vector<Sine>& sines);

/// How one joint moves: centre + sines.
struct JointMotion {
  double centre = 0.0;  ///< [rad]
  std::vector<Sine> sines;
};

/// What a motion must never exceed.
struct MotionLimits {
  double tilt = 0.35;  ///< of the reference's joints 1 and 2, within ± [rad]
  double rate = 4.0;   ///< of each joint of the reference [rad/s]
  /// Angle between rotor and reference [rad]: a share of it fades the excitation, all of it stops
  /// the motion. Tilt and error together lie within the workspace.
  double error = 0.25;
  double coil_current = kUsualCoilCurrent;      ///< of each coil [A]
  double total_current = kUsualTotalCurrent;    ///< Σ|I| [A]
  double square_current = kUsualSquareCurrent;  ///< ΣI² [A²]: power of the coils per ohm of each
};

/// A motion that excites what calibration identifies: a smooth reference for the three joints, and
/// currents beside those that it costs, whose torque cancels by the model. Both go by the time of
/// the plan, which itself begins and ends slowly: the rotor is at rest at both ends.
struct MotionPlan {
  std::string actuator;    ///< name in the description
  std::string serial;      ///< of the unit; may be empty
  double duration = 60.0;  ///< of the motion, with the ramps [s]
  double ramp = 2.0;       ///< in which its time gathers speed, and loses it [s]
  MotionLimits limits;
  std::array<JointMotion, kJoints> joints;  ///< sensor angles
  std::vector<std::vector<Sine>> coils;     ///< excitation of each coil, before its projection
};

/// Sensor angles of the reference at a time of the plan [rad].
Eigen::Vector3d jointsAt(const MotionPlan& plan, double time);
/// Wanted excitation of each coil at a time of the plan [A].
Eigen::VectorXd excitationAt(const MotionPlan& plan, double time);

/// Throws ConfigError that names the value: what is not finite or out of range, joints or coils
/// that leave the plan's limits at any time, limits that leave the workspace, a plan that is for
/// another actuator, another unit or another number of coils.
void validate(const MotionPlan& plan, const Actuator& actuator);

/// The time of a motion plan against time: it rests at first, runs as fast as time between the
/// ramps, and rests at the end. Rate and its change are smooth.
class MotionTime {
 public:
  /// Precondition: 0 < 2 ramp ≤ duration.
  MotionTime(double duration, double ramp) : duration_(duration), ramp_(ramp) {}

  /// Time of the plan at a time since the begin [s]; it never falls.
  double at(double time) const;
  /// Its rate, 0 to 1.
  double rateAt(double time) const;
  /// From this time on it slows down, unless it does already.
  void endAt(double time);
  /// When it has come to rest [s].
  double end() const { return duration_; }

 private:
  double since(double end_begin, double rate, double time) const;

  double duration_;
  double ramp_;
  /// Where it was when it was ended early.
  bool is_ended_ = false;
  double ended_at_ = 0.0;
  double rate_then_ = 1.0;
  double plan_then_ = 0.0;
};

}  // namespace sac
