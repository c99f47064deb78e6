#include "spherical_actuator_calibration/planning/planned_capture.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {
namespace {

bool holdsZeroOf(const Sample& sample, const std::vector<Sample>& held, double current_threshold) {
  return std::any_of(held.begin(), held.end(), [&](const Sample& other) {
    return other.dwell == sample.dwell && patternOf(other, current_threshold).empty();
  });
}

}  // namespace

CoilPattern patternOf(const Sample& sample, double current_threshold) {
  CoilPattern pattern;
  for (const Excitation& excitation : excitedCoils(sample, current_threshold)) {
    pattern.push_back({excitation.coil, excitation.current < 0.0 ? -1 : 1});
  }
  return pattern;
}

bool isAtPose(const Sample& sample, const Eigen::Vector3d& joint_position) {
  return ((sample.joint_position - joint_position).array().abs() <= kPoseTolerance).all();
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

double captureDuration(const PlannedCapture& planned, double duration) {
  constexpr double kWithoutCurrent = 3.0;
  return planned.pattern.empty() ? kWithoutCurrent * duration : duration;
}

}  // namespace sac
