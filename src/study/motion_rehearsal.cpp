#include "spherical_actuator_calibration/study/motion_rehearsal.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/emulation/free_rotor.hpp"

namespace sac {
namespace {

constexpr double kIntegrationStep = 1e-3;  // of integration [s]
constexpr Stamp kCycle = 1'000'000;
constexpr double kStopTilt = 1.2;  // [rad] far beyond what is allowed

void validate(const RehearsalOptions& options) {
  const ValueRange rate = ValueRange::closed(10.0, 1.0 / kIntegrationStep, "Hz");
  requireInRange("joint_rate", options.joint_rate, rate);
  requireInRange("current_rate", options.current_rate, rate);
  requireInRange("joint_noise", options.joint_noise, ValueRange::nonNegative("rad"));
  requireInRange("time_constant", options.time_constant, ValueRange::nonNegative("s"));
}

/// Every so many cycles of control something happens.
int cyclesOf(double rate) {
  return std::max(1, static_cast<int>(std::lround(1.0 / (rate * kIntegrationStep))));
}

class Stage {
 public:
  Stage(const MotionPlan& plan,
        const Actuator& model,
        const Actuator& truth,
        const RehearsalOptions& options)
      : options_(options),
        rotor_(truth, options.rotor, kStopTilt, options.friction),
        controller_(model, options.controller),
        noise_(options.seed, RandomPurpose::kMotionRehearsal),
        command_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(truth.coils.size()))),
        setpoints_(command_),
        currents_(command_) {
    rotor_.release(jointsAt(plan, 0.0));
    controller_.setParameters(model);
    sense();
    controller_.enable(now_);
    controller_.follow(plan);
  }

  Rehearsal run() {
    int cycles_in_motion = 0;
    double sum_of_totals = 0.0;
    double sum_of_shares = 0.0;
    while (controller_.state() == ControlState::kActive) {
      const bool is_in_motion = controller_.motionProgress().phase == MotionPhase::kMotion;
      cycle();
      if (is_in_motion) {
        const double share = controller_.motionProgress().least_excitation_share;
        result_.least_excitation_share = std::min(result_.least_excitation_share, share);
        sum_of_shares += share;
        sum_of_totals += currents_.cwiseAbs().sum();
        ++cycles_in_motion;
      }
    }
    const MotionProgress progress = controller_.motionProgress();
    result_.completed = progress.phase == MotionPhase::kDone;
    result_.reason = controller_.stopReason();
    result_.largest_tracking_error = progress.largest_tracking_error;
    if (cycles_in_motion > 0) {
      result_.mean_total_current = sum_of_totals / cycles_in_motion;
      result_.mean_excitation_share = sum_of_shares / cycles_in_motion;
    }
    return result_;
  }

 private:
  void sense() {
    controller_.receive({now_, rotor_.position() + noise_.gaussianVector(options_.joint_noise)});
  }

  void cycle() {
    now_ += kCycle;
    ++cycles_;
    if (cycles_ % cyclesOf(options_.joint_rate) == 0) {
      sense();
      command_ = controller_.update(now_);
      noteCommand();
    }
    if (cycles_ % cyclesOf(options_.current_rate) == 0) {
      setpoints_ = command_;
    }
    // Half of the lag before, half after: the currents of the middle of the cycle.
    const double share = options_.time_constant > 0.0
                             ? -std::expm1(-0.5 * kIntegrationStep / options_.time_constant)
                             : 1.0;
    currents_ += share * (setpoints_ - currents_);
    rotor_.advance(kIntegrationStep, currents_);
    currents_ += share * (setpoints_ - currents_);
    result_.largest_tilt =
        std::max(result_.largest_tilt, rotor_.position().head<2>().cwiseAbs().maxCoeff());
  }

  void noteCommand() {
    result_.largest_coil_current =
        std::max(result_.largest_coil_current, command_.cwiseAbs().maxCoeff());
    result_.largest_total_current =
        std::max(result_.largest_total_current, command_.cwiseAbs().sum());
    result_.largest_square_current =
        std::max(result_.largest_square_current, command_.squaredNorm());
  }

  const RehearsalOptions& options_;
  FreeRotor rotor_;
  OrientationController controller_;
  NoiseSource noise_;
  Stamp now_ = 1000 * kCycle;
  int cycles_ = 0;
  Eigen::VectorXd command_;
  Eigen::VectorXd setpoints_;
  Eigen::VectorXd currents_;
  Rehearsal result_;
};

}  // namespace

Rehearsal rehearse(const MotionPlan& plan,
                   const Actuator& model,
                   const Actuator& truth,
                   const RehearsalOptions& options) {
  validate(options);
  return Stage(plan, model, truth, options).run();
}

}  // namespace sac
