#pragma once

#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/control/computed_torque_control.hpp"
#include "spherical_actuator_calibration/control/excitation.hpp"
#include "spherical_actuator_calibration/measurement/motion_plan.hpp"

namespace sac {

/// How far a planned motion is (message MotionStatus).
enum class MotionPhase {
  kNone,      ///< no motion was begun
  kApproach,  ///< the rotor turns to where the motion begins
  kMotion,
  kEnding,    ///< slows down, because somebody wants it
  kSettling,  ///< the reference is at rest, the rotor comes to rest
  kDone,      ///< at its end, as planned or as somebody wanted; no current
  kStopped,   ///< the control stopped by itself; no current
};

/// Its name in messages: approach, motion…
const char* motionPhaseName(MotionPhase phase);
/// Whether a motion goes on in it.
bool isRunning(MotionPhase phase);

/// How far a motion is.
struct MotionProgress {
  MotionPhase phase = MotionPhase::kNone;
  double elapsed = 0.0;                 ///< of the motion [s]
  double duration = 0.0;                ///< of the motion [s]
  double largest_tracking_error = 0.0;  ///< since its begin [rad]
  double least_excitation_share = 1.0;  ///< that the limits left since it was asked last, 0 to 1
  double least_torque_share = 1.0;      ///< likewise
};

/// One motion plan as it is carried out, cycle by cycle. Not thread-safe.
class MotionRun {
 public:
  /// Precondition: the plan is valid for the actuator.
  explicit MotionRun(const MotionPlan& plan);

  const MotionPlan& plan() const { return plan_; }
  MotionPhase phase() const { return progress_.phase; }
  bool isRunning() const { return sac::isRunning(progress_.phase); }
  const CurrentBounds& bounds() const { return bounds_; }

  /// Where it begins, R_stator_rotor.
  Eigen::Matrix3d begin(const JointGeometry& joints) const;
  /// The rotor on its approach: so far from the begin [rad], the reference and the rotor so fast
  /// [rad/s]. Returns why it must stop, or nothing.
  std::string approach(double step, double distance, double reference_rate, double rotor_rate);
  /// On by `step` [s], once it has begun.
  void advance(double step);
  /// Slows down from now on, and ends.
  void end();
  /// The control has stopped.
  void stop();

  /// The reference of this cycle.
  DesiredMotion desired(const JointGeometry& joints) const;
  /// Excitation of this cycle to be added to the currents of the control [A]: without torque by the
  /// model, faded where the rotor is far from the reference or will soon be, and within the bounds.
  Eigen::VectorXd excitation(const Eigen::Matrix3Xd& torque_per_ampere,
                             const Eigen::VectorXd& control,
                             const RotorState& rotor,
                             const DesiredMotion& desired);
  /// Share of the control's torque that the limits allowed in this cycle.
  void noteTorqueShare(double share);

  const MotionProgress& progress() const { return progress_; }
  /// The least shares begin anew.
  void resetShares();

 private:
  MotionPlan plan_;
  MotionTime time_;
  CurrentBounds bounds_;
  MotionProgress progress_;
  double waited_ = 0.0;   ///< on the approach [s]
  double settled_ = 0.0;  ///< at the begin, or at the end [s]
};

}  // namespace sac
