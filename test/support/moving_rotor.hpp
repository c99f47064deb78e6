#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include <Eigen/Core>
#include <Eigen/QR>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"
#include "support/scenarios.hpp"

namespace sac {

/// A free rotor that follows sums of sines with a controller that knows the drawing only, recorded
/// at a kilohertz without noise. A current holds for the millisecond after its stamp: it acts half
/// a millisecond later than it says.
struct MovingRotor {
  Actuator truth = scenarios::paperNominal();
  RigidRotor rotor;
  double duration = 6.0;       ///< [s]
  double push = 0.0;           ///< [N·m] of a hand about the stator's z
  double push_begin = 2.0;     ///< [s]
  double push_end = 2.3;       ///< [s]
  double current_delay = 0.0;  ///< [s]
  double tracker_delay = 0.0;  ///< [s]
  bool has_tracker = true;
  std::size_t coil_that_is_off = 0;  ///< has no current
  double off_until = 0.0;            ///< [s]

  static Eigen::Matrix3d reference(double t) {
    const Eigen::Vector3d q(0.25 * std::sin(1.9 * t) + 0.1 * std::sin(3.1 * t),
                            0.2 * std::sin(2.3 * t + 1.0) + 0.12 * std::cos(1.2 * t),
                            2.0 * std::sin(0.9 * t) + 0.9 * std::sin(1.7 * t));
    return rotorOrientation(JointGeometry(), q);
  }

  /// Different in each coil [A].
  static Eigen::VectorXd excitation(double t, Eigen::Index coils) {
    Eigen::VectorXd current(coils);
    for (Eigen::Index j = 0; j < coils; ++j) {
      const double n = static_cast<double>(j);
      current[j] = 0.25 * std::sin((3.0 + 0.83 * n) * t + n * n) +
                   0.2 * std::sin((20.0 - 0.61 * n) * t + 2.0 * n);
    }
    return current;
  }

  MotionRecording record() const {
    constexpr double kStep = 1e-3;
    const TorqueCurve curve(*truth.torque_curve);
    const TorqueGeometry made = torqueGeometry(truth);
    const TorqueGeometry drawn = torqueGeometry(scenarios::paperNominal());
    const auto coils = static_cast<Eigen::Index>(truth.coils.size());
    MotionRecorder recorder(truth.coils.size());
    RotorState state;
    state.R_stator_rotor = reference(0.0);
    Eigen::Vector3d angles = Eigen::Vector3d::Zero();
    const auto stamp = [](double t) { return static_cast<Stamp>(std::llround((t + 10.0) * 1e9)); };
    for (int n = 0; n * kStep < duration; ++n) {
      const double t = n * kStep;
      const Eigen::Matrix3d& R = state.R_stator_rotor;
      const Eigen::Vector3d rate =
          rotationLog(reference(t + kStep) * reference(t - kStep).transpose()) / (2.0 * kStep);
      const Eigen::Vector3d torque =
          1e-3 * (20.0 * (R.transpose() * rate - state.angular_velocity) +
                  100.0 * (R.transpose() * rotationLog(reference(t) * R.transpose())));
      const Eigen::Matrix3Xd Q = torquePerAmpere(curve, drawn, R);
      const Eigen::VectorXd wish = excitation(t, coils);
      Eigen::VectorXd current = wish + Q.completeOrthogonalDecomposition().solve(torque - Q * wish);
      if (t < off_until) {
        current[static_cast<Eigen::Index>(coil_that_is_off)] = 0.0;
      }
      angles = jointAngles(jointGeometry(truth.joints), R, angles).value();
      recorder.add(JointMeasurement{stamp(t), angles});
      recorder.add(CurrentMeasurement{stamp(t + current_delay), current});
      if (has_tracker && n % 4 == 0) {
        recorder.add(OrientationMeasurement{stamp(t + tracker_delay), Eigen::Quaterniond(R)});
      }
      const bool is_pushed = push != 0.0 && t >= push_begin && t < push_end;
      state = advance(
          rotor,
          state,
          [&](const Eigen::Matrix3d& orientation) -> Eigen::Vector3d {
            return rotorTorque(curve, made, orientation, current) +
                   (is_pushed ? push : 0.0) * Eigen::Vector3d::UnitZ();
          },
          kStep);
    }
    return recorder.take();
  }
};

/// A recording with the noise of good sensors: 2e-5 rad of joints, 1 mA of currents, 5e-4 rad of
/// orientations. Without any, what the rotor does between samples is all misfit.
/// `joint_stddev`: of readings [rad].
inline MotionRecording noisy(MotionRecording recording, double joint_stddev = 2e-5) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  const auto noise = [&](double stddev) -> Eigen::Vector3d {
    return stddev * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
  };
  for (MotionStreams& streams : recording.spans) {
    for (Eigen::Vector3d& reading : streams.joints) {
      reading += noise(joint_stddev);
    }
    auto currents = streams.currents.matrix();
    for (Eigen::Index n = 0; n < currents.size(); ++n) {
      currents.data()[n] += static_cast<float>(1e-3 * normal(generator));
    }
    for (Eigen::Quaterniond& orientation : streams.orientations) {
      orientation = Eigen::Quaterniond(rotationExp(noise(5e-4))) * orientation;
    }
  }
  return recording;
}

}  // namespace sac
