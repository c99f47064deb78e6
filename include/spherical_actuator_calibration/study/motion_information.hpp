#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/measurement/motion_plan.hpp"

namespace sac {

/// What is recorded of a motion, and how well.
struct MotionSensors {
  double joint_rate = 200.0;         ///< [Hz]
  double joint_stddev = 2.5e-5;      ///< of a reading [rad]
  double current_rate = 200.0;       ///< [Hz]
  double current_stddev = 1e-3;      ///< of a coil's reading [A]
  double tracker_rate = 240.0;       ///< [Hz]; 0: there is none
  double tracker_stddev = 5.774e-4;  ///< per component [rad]
  double tolerance = 0.03;           ///< stddev of a coordinate before [rad]
};

/// Throws ConfigError that names the value and its range.
void validate(const MotionSensors& sensors);

/// Expected standard deviations of the coordinates of the model's space after a motion along the
/// plan [rad], as calibration from windows in the weak form of momentum balance gives them
/// (doc/motion_plans.md): an approximation at the model's parameters, along the reference, with the
/// currents that the controller would command, of continuous streams. Inertia, centre of gravity,
/// friction and delays count as unknown. One window of `every` is looked at, and stands for all.
/// Precondition: the plan is valid, the model has a torque model.
Eigen::VectorXd expectedStddevs(const CalibrationModel& model,
                                const RigidRotor& rotor,
                                const MotionPlan& plan,
                                const MotionSensors& sensors,
                                int every);

}  // namespace sac
