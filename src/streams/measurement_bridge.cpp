#include "spherical_actuator_calibration/streams/measurement_bridge.hpp"

#include <cmath>
#include <utility>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/measurement/stamp_interval.hpp"

namespace sac {
namespace {

StampFilterOptions stampOptions(const MeasurementBridgeOptions& options) {
  StampFilterOptions stamps;
  stamps.clock_reset = options.clock_reset;
  stamps.largest_jump = options.largest_step;
  return stamps;
}

void requireFinite(const MarkerPoseMeasurement& pose) {
  if (!pose.position.allFinite() || !pose.q_tracker_marker.coeffs().allFinite()) {
    throw DataError("the pose is not finite: the tracker has lost the marker");
  }
}

void requireUnit(const MarkerPoseMeasurement& pose) {
  if (!isUnit(pose.q_tracker_marker)) {
    throw DataError("the norm of its quaternion is " +
                    std::to_string(pose.q_tracker_marker.norm()) +
                    ", not 1: check the tracker's driver");
  }
}

}  // namespace

MeasurementBridge::MeasurementBridge(const MeasurementBridgeOptions& options)
    : options_(options),
      pose_stamps_(stampOptions(options)),
      wrench_stamps_(stampOptions(options)),
      jumps_(options.jumps),
      history_(options.largest_wait + options.largest_gap, options.largest_gap) {}

OrientationMeasurement MeasurementBridge::orientation(const MarkerPoseMeasurement& pose,
                                                      const Eigen::Isometry3d& X_stator_tracker,
                                                      const Eigen::Isometry3d& X_rotor_marker) {
  requireFinite(pose);
  requireUnit(pose);
  judgeStamp(pose_stamps_, pose.stamp);
  Registration registration;
  registration.X_stator_tracker = X_stator_tracker;
  registration.X_rotor_marker = X_rotor_marker;
  OrientationMeasurement orientation = orientationFromMarkerPose(registration, pose);
  const Eigen::Quaterniond q_stator_rotor = orientation.q_stator_rotor.normalized();
  if (!jumps_.judge(pose.stamp, q_stator_rotor)) {
    throw DataError(
        "the orientation jumped further than the rotor can turn: see that the tracker "
        "follows the right marker");
  }
  if (options_.sensor_mount == SensorMount::kStator) {
    history_.add({pose.stamp, q_stator_rotor});
    answerWaiting();
  }
  return orientation;
}

void MeasurementBridge::add(const WrenchMeasurement& wrench,
                            const Eigen::Isometry3d& X_mount_sensor) {
  if (!wrench.force.allFinite() || !wrench.torque.allFinite()) {
    throw DataError("the wrench is not finite: check the force/torque sensor");
  }
  judgeStamp(wrench_stamps_, wrench.stamp);
  if (options_.sensor_mount == SensorMount::kRotor) {
    Registration registration;
    registration.X_rotor_sensor = X_mount_sensor;
    ready_.measurements.push_back(torqueFromWrench(registration, wrench));
    return;
  }
  newest_wrench_ = wrench.stamp;
  waiting_.push_back({wrench, X_mount_sensor});
  answerWaiting();
}

MeasurementBridge::Torques MeasurementBridge::takeTorques() {
  return std::exchange(ready_, {});
}

void MeasurementBridge::judgeStamp(StampFilter& filter, Stamp stamp) {
  const StampFilter::Verdict verdict = filter.judge(stamp);
  if (verdict.drop) {
    throw DataError(std::string("the measurement is ") + describe(*verdict.drop));
  }
  if (verdict.clock_reset) {
    ++clock_resets_;
    restart();
  }
}

// What was measured by the clock before its reset has no place in the new time. The other stream's
// stamps stay as they are: it finds out by itself.
void MeasurementBridge::restart() {
  jumps_.restart();
  history_.clear();
  waiting_.clear();
}

void MeasurementBridge::answerWaiting() {
  while (!waiting_.empty() && answer(waiting_.front())) {
    waiting_.pop_front();
  }
}

bool MeasurementBridge::answer(const WaitingWrench& waiting) {
  const OrientationHistory::Lookup lookup = history_.at(waiting.wrench.stamp);
  if (lookup.answer == OrientationHistory::Answer::kKnown) {
    ready_.measurements.push_back(
        torqueFromStatorWrench(waiting.X_stator_sensor, lookup.q_stator_rotor, waiting.wrench));
    return true;
  }
  const bool in_time =
      newest_wrench_ - waiting.wrench.stamp <= ticksFromSeconds(options_.largest_wait);
  if (lookup.answer == OrientationHistory::Answer::kNotYet && in_time) {
    return false;
  }
  ready_.refusals.emplace_back(
      "no orientation was measured around the wrench: see that the tracker "
      "sees the marker");
  return true;
}

}  // namespace sac
