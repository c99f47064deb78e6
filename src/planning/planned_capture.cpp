#include "spherical_actuator_calibration/planning/planned_capture.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/measurement/carried_currents.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

namespace sac {
namespace {

bool holdsZeroOf(const Sample& sample, const std::vector<Sample>& held, double current_threshold) {
  return std::any_of(held.begin(), held.end(), [&](const Sample& other) {
    return other.dwell == sample.dwell && patternOf(other, current_threshold).empty();
  });
}

}  // namespace

std::optional<std::size_t> coilAmiss(const PlannedCapture& planned,
                                     const Eigen::VectorXd& measured,
                                     double current_threshold) {
  Eigen::VectorXd commanded = Eigen::VectorXd::Zero(measured.size());
  for (const SignedCoil& coil : planned.pattern) {
    const auto j = static_cast<Eigen::Index>(coil.coil);
    if (j >= measured.size()) {
      return coil.coil;
    }
    commanded[j] = coil.sign * planned.current;
  }
  return coilAmiss(commanded, measured, current_threshold);
}

CaptureFlaw captureFlaw(const Sample& sample,
                        const PlannedCapture& planned,
                        const std::vector<Sample>& held,
                        double current_threshold) {
  const bool is_excited = !planned.pattern.empty();
  if (!sample.has_orientation) {
    return CaptureFlaw::kOrientation;
  }
  if (!(patternOf(sample, current_threshold) == planned.pattern)) {
    return CaptureFlaw::kCurrents;
  }
  if (is_excited && !sample.has_torque) {
    return CaptureFlaw::kTorque;
  }
  if (!isAtPose(sample, planned.joint_position)) {
    return CaptureFlaw::kPose;
  }
  if (is_excited && !holdsZeroOf(sample, held, current_threshold)) {
    return CaptureFlaw::kRest;
  }
  return CaptureFlaw::kNone;
}

std::string flawName(CaptureFlaw flaw) {
  switch (flaw) {
    case CaptureFlaw::kNone:
      break;
    case CaptureFlaw::kExcitation:
      return "excitation";
    case CaptureFlaw::kOrientation:
      return "orientation";
    case CaptureFlaw::kCurrents:
      return "currents";
    case CaptureFlaw::kTorque:
      return "torque";
    case CaptureFlaw::kPose:
      return "pose";
    case CaptureFlaw::kRest:
      return "rest";
  }
  return "";
}

std::string flawInWords(CaptureFlaw flaw) {
  switch (flaw) {
    case CaptureFlaw::kNone:
      break;
    case CaptureFlaw::kExcitation:
      return "The coils do not carry their currents: check the amplifier and the coil driver.";
    case CaptureFlaw::kOrientation:
      return "The sample has no orientation: check the tracker.";
    case CaptureFlaw::kCurrents:
      return "The currents are not those of the plan, or changed during the capture: check the "
             "amplifier.";
    case CaptureFlaw::kTorque:
      return "The sample has no torque: check the force/torque sensor.";
    case CaptureFlaw::kPose:
      return "The rotor has left the pose: bring it back.";
    case CaptureFlaw::kRest:
      return "The rest was interrupted: the torque without current is to be measured anew.";
  }
  return "";
}

std::string amissInWords(const PlannedCapture& planned, std::size_t coil) {
  const bool is_excited = std::any_of(planned.pattern.begin(),
                                      planned.pattern.end(),
                                      [coil](const SignedCoil& each) { return each.coil == coil; });
  return "Coil " + std::to_string(numberOf(coil)) +
         (is_excited ? " does not carry its current" : " is not free of current") +
         ": check the amplifier and the coil driver.";
}

double captureDuration(const PlannedCapture& planned, double duration, double longest) {
  constexpr double kWithoutCurrent = 3.0;
  return planned.pattern.empty() && duration < longest
             ? std::min(kWithoutCurrent * duration, longest)
             : duration;
}

}  // namespace sac
