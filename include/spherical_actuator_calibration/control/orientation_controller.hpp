#pragma once

#include <optional>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/control/computed_torque_control.hpp"
#include "spherical_actuator_calibration/control/disturbance_observer.hpp"
#include "spherical_actuator_calibration/control/motion_run.hpp"
#include "spherical_actuator_calibration/control/orientation_controller_options.hpp"
#include "spherical_actuator_calibration/control/orientation_reference.hpp"
#include "spherical_actuator_calibration/measurement/measurements.hpp"

namespace sac {

/// Whether the controller commands currents.
enum class ControlState {
  kIdle,     ///< not enabled: no current
  kActive,   ///< follows its targets
  kStopped,  ///< stopped by itself: no current until it is enabled again
};

/// What keeps currents from making the whole torque.
enum class CurrentLimit { kNone, kCoil, kTotal, kPower };

/// Torque that was cut.
struct TorqueCut {
  double share = 1.0;  ///< of the wanted torque that was made
  CurrentLimit limit = CurrentLimit::kNone;
};

/// "the currents are at their limit (power/limit, of all coils): down to 40 % of the wanted torque"
std::string inWords(const TorqueCut& cut);

/// Turns the rotor to target orientations by computed torque: orientation and velocity from the
/// joint sensors, or without joints from the tracker, torques and currents by the parameters in
/// force. It stops by itself, with all currents zero, when readings are too old, outside the
/// workspace, where the coils make no torque in some direction, when the rotor does not follow, or
/// when measured currents that came come no more.
/// A motion plan is followed in the place of targets, under the same guards and its own limits. A
/// load that nobody told of is found and held; while a motion plan is followed, what was found
/// before stays. Not thread-safe.
class OrientationController {
 public:
  /// `design`: numbers, torque curve and workspace. Throws ConfigError when it has no torque model
  /// or an option is not valid.
  OrientationController(const Actuator& design, const OrientationControllerOptions& options);

  /// Parameters in force from now on; as many poles and coils as the design. While active, the
  /// torque on the rotor goes on without a jump, and the desired motion returns to the target
  /// within a second; during a motion plan, those before stay in force until it has ended. Throws
  /// ConfigError when they are not valid.
  void setParameters(const Actuator& parameters);
  /// Whether those of the last call wait for the end of a motion.
  bool hasParametersToCome() const { return parameters_to_come_.has_value(); }
  /// A reading of the joint sensors; false when it is not newer than the last, and changes nothing.
  /// After a jump of the clock it begins anew. Throws DataError when it cannot be an angle.
  bool receive(const JointMeasurement& joints);
  /// The same for a rotor without joints, of the tracker's orientation.
  bool receive(const OrientationMeasurement& orientation);
  /// What flows in the coils, which need not be known.
  void receiveCurrents(const CurrentMeasurement& currents);
  /// Where to turn. Throws DataError, and keeps the target before it, for what is no rotation, lies
  /// outside the workspace, or cannot be reached straight within it, and during a motion plan.
  void setTarget(Stamp stamp, const Eigen::Matrix3d& R_stator_rotor);
  /// Orientation R_stator_rotor at raw joint sensor angles `q` [rad], by the parameters in force.
  Eigen::Matrix3d orientationAt(const Eigen::Vector3d& q) const {
    return rotorOrientation(joints_, q);
  }

  /// Takes hold of the rotor where it is. Throws DataError with the reason why that cannot be.
  void enable(Stamp now);
  void disable();
  /// A safe stop: no current until it is enabled again. Changes nothing unless active.
  void stop(const std::string& reason);

  /// Turns the rotor to where the plan begins, then along it, to its end: at rest, with all
  /// currents zero, not enabled. Throws DataError with the reason when it is not active, follows a
  /// plan already, or cannot reach its begin, ConfigError when the plan does not fit the actuator.
  void follow(const MotionPlan& plan);
  /// The motion slows down to rest within its ramp, and ends there as if it were over.
  void endMotion();
  /// How far the motion is; its least shares begin anew.
  MotionProgress motionProgress();

  /// One cycle: the currents to command [A], zero unless active.
  const Eigen::VectorXd& update(Stamp now);

  ControlState state() const { return state_; }
  /// What readings are of: "joint angles", "orientations".
  const char* readings() const { return parameters_.has_joints ? "joint angles" : "orientations"; }
  /// Why it stopped, or nothing.
  const std::string& stopReason() const { return stop_reason_; }
  /// Whether it stopped because the rotor was too far from its reference, though currents flowed
  /// as commanded.
  bool isLost() const { return is_lost_; }
  /// Share of the wanted torque that the limits of the currents allowed in the last cycle.
  double torqueShare() const { return share_; }
  /// The least share since it was asked last, and the limit that allowed no more.
  TorqueCut takeTorqueCut() { return std::exchange(cut_, {}); }
  /// Angle between the orientation that the model sees and the reference [rad].
  double trackingError() const { return tracking_error_; }
  /// Torque on the rotor that was found and is made up for, rotor frame [N·m].
  const Eigen::Vector3d& disturbance() const { return disturbance_.torque(); }

 private:
  /// Readings farther apart tell no velocity [s].
  static constexpr double kLongestDifference = 0.1;

  /// What the model makes of the joint angles.
  RotorState rotorAt(const Eigen::Vector3d& q) const;
  std::string defectAt(Stamp now) const;
  std::string silenceAt(Stamp now) const;
  /// Why currents do not flow as commanded; empty: they do.
  std::string deviceFault(Stamp now) const;
  std::string limitAsReason() const;
  void keepTorque();
  const ControlGains& gains() const {
    return isInMotion() ? options_.motion_gains : options_.gains;
  }
  bool isInMotion() const { return motion_ && motion_->isRunning(); }
  bool isOnItsWay() const { return isInMotion() && motion_->phase() != MotionPhase::kApproach; }
  const DesiredMotion& desiredMotion(Stamp now, double step);
  void approachMotion(double step);
  void observe(Stamp now, const RotorState& rotor);
  Learning learning(Stamp now) const;
  void allocate(const RotorState& rotor, const DesiredMotion& desired);
  CurrentLimit limitTotal();
  void takeParametersToCome();
  Eigen::Matrix3d present() const;
  void requireWay(const Eigen::Matrix3d& R_stator_rotor) const;

  Actuator parameters_;
  bool has_parameters_ = false;
  OrientationControllerOptions options_;
  Eigen::Vector3d configured_unbalance_;  ///< of the rotor [N·m]
  TorqueCurve curve_;
  JointGeometry joints_;
  TorqueGeometry torques_;
  OrientationReference reference_;
  DisturbanceObserver disturbance_;
  Stamp observed_ = 0;  ///< the reading that the observer saw last
  Eigen::Vector3d coil_torque_ = Eigen::Vector3d::Zero();  ///< of the last cycle, rotor frame [N·m]
  std::optional<JointMeasurement> measured_;  ///< without joints, see freeRotorJoints()
  Eigen::Vector3d joint_velocity_ = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d q_ = Eigen::Vector3d::Zero();  ///< joint angles of the last cycle [rad]
  std::optional<Stamp> last_update_;
  // Since it was enabled.
  std::optional<Stamp> current_stamp_;  ///< of the newest measured currents
  bool currents_flow_ = false;          ///< they come often
  double measured_sum_ = 0.0;           ///< of the absolute values lately [A]
  double commanded_sum_ = 0.0;          ///< the same of those commanded
  ControlState state_ = ControlState::kIdle;
  std::string stop_reason_;
  bool is_lost_ = false;
  Eigen::VectorXd currents_;
  double share_ = 1.0;
  CurrentLimit limit_ = CurrentLimit::kNone;  ///< of the last cycle
  TorqueCut cut_;
  double tracking_error_ = 0.0;
  std::optional<MotionRun> motion_;
  DesiredMotion motion_reference_;
  std::optional<Actuator> parameters_to_come_;  ///< after the motion
};

}  // namespace sac
