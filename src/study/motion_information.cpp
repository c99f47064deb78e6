#include "spherical_actuator_calibration/study/motion_information.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/control/current_allocation.hpp"
#include "spherical_actuator_calibration/control/motion_run.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"
#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/motion/test_functions.hpp"

namespace sac {
namespace {

// What a calibration by motion makes of it.
constexpr MotionOptions kOptions;
constexpr double kWindow = kOptions.window;
constexpr int kTests = kOptions.test_functions;
constexpr double kFrictionTransition = kOptions.friction_speed;
constexpr int kSamples = 50;  // of a window
constexpr double kStep = kWindow / kSamples;

// Unknowns of the laboratory behind the coordinates of the model.
constexpr Eigen::Index kInertia = 0;
constexpr Eigen::Index kUnbalance = 6;
constexpr Eigen::Index kFriction = 9;
constexpr Eigen::Index kCurrentDelay = 11;
constexpr Eigen::Index kTrackerDelay = 12;
constexpr Eigen::Index kNuisances = 13;

using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Momentum and torque at one time of the motion, by all unknowns, in the stator frame.
struct Moment {
  Rows momentum;                   ///< ∂L/∂x
  Rows torque;                     ///< ∂(RT)/∂x
  Rows orientation;                ///< ∂ξ/∂x, and by the tracker's delay
  Eigen::Matrix3d joint_momentum;  ///< R J Rᵀ ∂ξ/∂q
  Eigen::Matrix3d joint_torque;    ///< ∂(RT)/∂q
  Eigen::Matrix3d current_torque;  ///< R Q Qᵀ Rᵀ [(N·m/A)²]
};

/// All test functions at one sample of a window.
struct TestsAtSample {
  TestFunctionValues values;
  TestFunctionBends bends;
};

std::vector<TestsAtSample> testsOfWindow() {
  const TestFunctions functions(0.0, kWindow, kTests);
  std::vector<TestsAtSample> tests(kSamples);
  for (int n = 0; n < kSamples; ++n) {
    TestsAtSample& at = tests[static_cast<std::size_t>(n)];
    functions.evaluate((n + 0.5) * kStep, at.values);
    functions.evaluate((n + 0.5) * kStep, at.bends);
  }
  return tests;
}

/// The motion as the controller would carry it out, were the model true.
class PlannedMotion {
 public:
  PlannedMotion(const CalibrationModel& model, const RigidRotor& rotor, const MotionPlan& plan)
      : model_(model),
        rotor_(rotor),
        plan_(plan),
        run_(plan),
        time_(plan.duration, plan.ramp),
        joints_(jointGeometry(model.space().nominal())),
        torques_(torqueGeometry(model.space().nominal())),
        size_(model.space().size()),
        point_(model, Eigen::VectorXd::Zero(size_)) {}

  /// Currents of the control and the excitation at a time [A].
  Eigen::VectorXd currentsAt(double time) {
    MotionRun run = run_;
    run.advance(time);
    const DesiredMotion desired = run.desired(joints_);
    const Eigen::Matrix3Xd Q = torquePerAmpere(model_.curve(), torques_, desired.R_stator_rotor);
    const RotorState rotor_state{desired.R_stator_rotor, desired.angular_velocity};
    const Eigen::Vector3d torque = computedTorque(rotor_, rotor_state, desired, ControlGains{});
    const Eigen::VectorXd control =
        allocateCurrents(Q, torque, {plan_.limits.coil_current, 1e-6}).currents;
    return control + run.excitation(Q, control, rotor_state, desired);
  }

  Moment momentAt(double time) {
    MotionRun run = run_;
    run.advance(time);
    const DesiredMotion desired = run.desired(joints_);
    const Eigen::Matrix3d& R = desired.R_stator_rotor;
    const Eigen::VectorXd currents = currentsAt(time);
    const Eigen::Matrix3Xd Q = R * torquePerAmpere(model_.curve(), torques_, R);
    const Eigen::Matrix3d J = R * rotor_.inertia * R.transpose();
    const Eigen::Vector3d w = R * desired.angular_velocity;

    Moment moment;
    moment.orientation = Rows::Zero(3, size_ + kNuisances);
    moment.orientation.leftCols(size_) = turning(time);
    moment.orientation.col(size_ + kTrackerDelay) = w;
    const Rows turning_rate = (turning(time + kStep) - turning(time - kStep)) / (2.0 * kStep);
    const Rows turned = moment.orientation.leftCols(size_);

    moment.momentum = Rows::Zero(3, size_ + kNuisances);
    moment.momentum.leftCols(size_) = J * turning_rate - skew(J * w) * turned;
    moment.torque = Rows::Zero(3, size_ + kNuisances);
    moment.torque.leftCols(size_) =
        R * torqueJacobian(time, currents) - skew(Q * currents) * turned;
    addNuisances(moment, desired, Q * currentRate(time));

    moment.joint_momentum.setZero();
    moment.joint_torque.setZero();
    for (std::size_t k = 0; k < kJoints; ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      moment.joint_momentum.col(column) = J * turned.col(model_.space().joint(k));
      moment.joint_torque.col(column) = moment.torque.col(model_.space().joint(k));
    }
    moment.current_torque = Q * Q.transpose();
    return moment;
  }

 private:
  Sample sampleAt(double time) const {
    Sample sample;
    sample.joint_position = jointsAt(plan_, time_.at(time));
    sample.R_stator_rotor = rotorOrientation(joints_, sample.joint_position);
    sample.has_orientation = true;
    return sample;
  }

  /// ∂ξ/∂x.
  Rows turning(double time) const {
    ResidualJacobian jacobian = ResidualJacobian::Zero(3, size_);
    point_.orientationResidual(sampleAt(time), &jacobian);
    return -jacobian;
  }

  /// ∂T/∂x, rotor frame.
  Rows torqueJacobian(double time, const Eigen::VectorXd& currents) const {
    Sample sample = sampleAt(time);
    sample.has_torque = true;
    sample.current = currents;
    ResidualJacobian jacobian = ResidualJacobian::Zero(3, size_);
    point_.torqueResidual(sample, excitedCoils(sample, 1e-9), &jacobian);
    return -jacobian;
  }

  Eigen::VectorXd currentRate(double time) {
    constexpr double kDifference = 1e-3;  // [s]
    return (currentsAt(time + kDifference) - currentsAt(time - kDifference)) / (2.0 * kDifference);
  }

  void addNuisances(Moment& moment,
                    const DesiredMotion& desired,
                    const Eigen::Vector3d& torque_rate) const {
    const Eigen::Matrix3d& R = desired.R_stator_rotor;
    const Eigen::Vector3d& w_rotor = desired.angular_velocity;
    const Eigen::Index first = size_;
    Eigen::Index column = first + kInertia;
    for (Eigen::Index a = 0; a < 3; ++a) {
      for (Eigen::Index b = a; b < 3; ++b) {
        Eigen::Vector3d part = Eigen::Vector3d::Zero();
        part[a] += w_rotor[b];
        part[b] += a == b ? 0.0 : w_rotor[a];
        moment.momentum.col(column++) = R * part;
      }
    }
    const Eigen::Vector3d gravity = gravityDirection(R);
    for (Eigen::Index c = 0; c < 3; ++c) {
      moment.torque.col(first + kUnbalance + c) = R * Eigen::Vector3d::Unit(c).cross(gravity);
    }
    const Eigen::Vector3d w = R * w_rotor;
    moment.torque.col(first + kFriction) = -w;
    moment.torque.col(first + kFriction + 1) = -w / std::hypot(w.norm(), kFrictionTransition);
    moment.torque.col(first + kCurrentDelay) = torque_rate;
  }

  const CalibrationModel& model_;
  const RigidRotor& rotor_;
  const MotionPlan& plan_;
  MotionRun run_;
  MotionTime time_;
  JointGeometry joints_;
  TorqueGeometry torques_;
  Eigen::Index size_;  ///< of the coordinates
  ModelPoint point_;   ///< nominal
};

/// Information of one window of torques by one of its test functions.
void addTest(const std::vector<Moment>& moments,
             const std::vector<TestsAtSample>& tests,
             int test,
             const MotionSensors& sensors,
             double weight,
             Eigen::MatrixXd& information) {
  Rows G = Rows::Zero(3, information.cols());
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  const double joint_variance = sensors.joint_stddev * sensors.joint_stddev / sensors.joint_rate;
  const double current_variance =
      sensors.current_stddev * sensors.current_stddev / sensors.current_rate;
  for (std::size_t n = 0; n < moments.size(); ++n) {
    const Moment& moment = moments[n];
    const double value = tests[n].values.value[test];
    G += kStep * (tests[n].values.first[test] * moment.momentum + value * moment.torque);
    const Eigen::Matrix3d by_joints =
        tests[n].bends.second[test] * moment.joint_momentum - value * moment.joint_torque;
    noise += kStep * (joint_variance * by_joints * by_joints.transpose() +
                      current_variance * value * value * moment.current_torque);
  }
  information += weight * G.transpose() * Cholesky3(noise).solve(G);
}

}  // namespace

void validate(const MotionSensors& sensors) {
  const ValueRange rate = ValueRange::positive("Hz");
  requireInRange("joint_rate", sensors.joint_rate, rate);
  requireInRange("current_rate", sensors.current_rate, rate);
  requireInRange("tracker_rate", sensors.tracker_rate, ValueRange::nonNegative("Hz"));
  requireInRange("joint_stddev", sensors.joint_stddev, ValueRange::positive("rad"));
  requireInRange("current_stddev", sensors.current_stddev, ValueRange::positive("A"));
  requireInRange("tracker_stddev", sensors.tracker_stddev, ValueRange::positive("rad"));
  requireInRange("tolerance", sensors.tolerance, ValueRange::positive("rad"));
}

Eigen::VectorXd expectedStddevs(const CalibrationModel& model,
                                const RigidRotor& rotor,
                                const MotionPlan& plan,
                                const MotionSensors& sensors,
                                int every) {
  const Eigen::Index size = model.space().size();
  PlannedMotion motion(model, rotor, plan);
  // What is known before: a third of the inertia, and of everything else next to nothing.
  Eigen::VectorXd prior = Eigen::VectorXd::Constant(size + kNuisances, sensors.tolerance);
  prior.segment(size + kInertia, 6).setConstant(0.3 * rotor.inertia.trace() / 3.0);
  prior.segment(size + kUnbalance, 3).setConstant(0.05);
  prior.segment(size + kFriction, 2).setConstant(0.05);
  prior.segment(size + kCurrentDelay, 2).setConstant(0.05);
  Eigen::MatrixXd information = prior.cwiseAbs2().cwiseInverse().asDiagonal();

  const std::vector<TestsAtSample> tests = testsOfWindow();
  const int windows = static_cast<int>(plan.duration / kWindow);
  for (int window = every / 2; window < windows; window += every) {
    std::vector<Moment> moments;
    for (int n = 0; n < kSamples; ++n) {
      moments.push_back(motion.momentAt(kWindow * window + kStep * (n + 0.5)));
      const Rows& turning = moments.back().orientation;
      const double weight =
          every * kStep * sensors.tracker_rate / (sensors.tracker_stddev * sensors.tracker_stddev);
      information += weight * turning.transpose() * turning;
    }
    for (int test = 0; test < kTests; ++test) {
      addTest(moments, tests, test, sensors, every, information);
    }
  }
  const Eigen::MatrixXd covariance = Cholesky(information).inverse();
  return covariance.diagonal().head(size).cwiseSqrt();
}

}  // namespace sac
