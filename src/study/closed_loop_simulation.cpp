#include "spherical_actuator_calibration/study/closed_loop_simulation.hpp"

#include <cmath>
#include <optional>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// Kinematics and torques of one set of parameters.
struct Parameters {
  explicit Parameters(const Actuator& actuator)
      : joints(jointGeometry(actuator.joints)),
        torques(torqueGeometry(actuator)),
        curve(*actuator.torque_curve) {}

  Eigen::Matrix3Xd torqueMatrix(const Eigen::Matrix3d& R_stator_rotor) const {
    return torquePerAmpere(curve, torques, R_stator_rotor);
  }

  JointGeometry joints;
  TorqueGeometry torques;
  TorqueCurve curve;
};

void validate(const ClosedLoopOptions& options) {
  controllable(options.truth);
  controllable(options.model);
  validate(options.rotor);
  validate(options.gains);
  requireInRange("duration", options.duration, ValueRange::positive("s"));
  requireInRange("step", options.step, ValueRange::positive("s"));
}

class ClosedLoop {
 public:
  ClosedLoop(const ClosedLoopOptions& options, const Trajectory& trajectory)
      : options_(options),
        trajectory_(trajectory),
        truth_(options.truth),
        model_(options.model),
        currents_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(options.truth.coils.size()))) {}

  ClosedLoopResult run() {
    ClosedLoopResult result;
    if (!begin()) {
      return result;
    }
    const auto steps = static_cast<int>(std::lround(options_.duration / options_.step));
    for (int n = 0; n <= steps; ++n) {
      const double time = n * options_.step;
      if (!sense() || !control(trajectory_(time))) {
        return result;
      }
      result.points.push_back(pointAt(time));
      state_ = advance(
          options_.rotor,
          state_,
          [this](const Eigen::Matrix3d& R) { return (truth_.torqueMatrix(R) * currents_).eval(); },
          options_.step);
    }
    result.completed = true;
    return result;
  }

 private:
  /// Where the model sees the desired orientation, and moves along with it.
  bool begin() {
    const DesiredMotion desired = trajectory_(0.0);
    const auto q = jointAngles(model_.joints, desired.R_stator_rotor, Eigen::Vector3d::Zero());
    if (!q) {
      return false;
    }
    q_ = *q;
    state_.R_stator_rotor = rotorOrientation(truth_.joints, q_);
    state_.angular_velocity =
        state_.R_stator_rotor.transpose() * desired.R_stator_rotor * desired.angular_velocity;
    seen_.R_stator_rotor = desired.R_stator_rotor;
    seen_.angular_velocity = desired.angular_velocity;
    return true;
  }

  /// Joint angles of the true orientation; orientation and velocity that the model makes of them.
  bool sense() {
    const auto q = jointAngles(truth_.joints, state_.R_stator_rotor, q_);
    if (!q) {
      return false;
    }
    const Eigen::Matrix3d R_model = rotorOrientation(model_.joints, *q);
    if (has_sensed_) {
      seen_.angular_velocity =
          rotationLog(seen_.R_stator_rotor.transpose() * R_model) / options_.step;
    }
    has_sensed_ = true;
    seen_.R_stator_rotor = R_model;
    q_ = *q;
    return true;
  }

  bool control(const DesiredMotion& desired) {
    desired_ = desired;
    const Eigen::Vector3d torque = computedTorque(options_.rotor, seen_, desired, options_.gains);
    const AllocatedCurrents allocated =
        allocateCurrents(model_.torqueMatrix(seen_.R_stator_rotor), torque, options_.allocation);
    currents_ = allocated.currents;
    return allocated.outcome != Allocation::kSingular;
  }

  ClosedLoopPoint pointAt(double time) const {
    ClosedLoopPoint point;
    point.time = time;
    point.joint_position = q_;
    point.R_stator_rotor = state_.R_stator_rotor;
    point.rotation_error =
        rotationLog(desired_.R_stator_rotor * state_.R_stator_rotor.transpose()).norm();
    point.largest_current = currents_.cwiseAbs().maxCoeff();
    return point;
  }

  const ClosedLoopOptions& options_;
  const Trajectory& trajectory_;
  Parameters truth_;
  Parameters model_;
  RotorState state_;  ///< true
  RotorState seen_;   ///< by the model
  bool has_sensed_ = false;
  Eigen::Vector3d q_ = Eigen::Vector3d::Zero();
  DesiredMotion desired_;
  Eigen::VectorXd currents_;
};

}  // namespace

ClosedLoopResult simulateClosedLoop(const ClosedLoopOptions& options,
                                    const Trajectory& trajectory) {
  validate(options);
  return ClosedLoop(options, trajectory).run();
}

}  // namespace sac
