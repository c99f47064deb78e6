#include <cstddef>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ros/console.h>

#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/calibration_node.hpp"
#include "spherical_actuator_calibration/ros/conversion/utc_date.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"

namespace sac {

bool CalibrationNode::calibrateMotion(msg::Calibrate::Request& /*request*/,
                                      msg::Calibrate::Response& response) {
  run({Cycle::kMotion}, response, std::make_shared<const MotionRecording>(intake_.motion()));
  const std::lock_guard<std::mutex> lock(session_mutex_);
  session_.setMotion(nullptr);
  return true;
}

bool CalibrationNode::forgetMotion(std_srvs::Trigger::Request& /*request*/,
                                   std_srvs::Trigger::Response& response) {
  answer(response, [&] {
    beginMotionAnew();
    publishStatus();
    return "The next motion begins anew.";
  });
  return true;
}

bool CalibrationNode::beginMotion(msg::BeginMotion::Request& request,
                                  msg::BeginMotion::Response& response) {
  answer(response, [&] {
    std::optional<double> wanted;
    if (request.wanted_stddev != 0.0) {
      requireInRange("wanted_stddev", request.wanted_stddev, wantedStddevRange());
      wanted = request.wanted_stddev;
    }
    beginMotionAnew(wanted);
    publishStatus();
    return "The next motion begins anew.";
  });
  return true;
}

void CalibrationNode::beginMotionAnew(std::optional<double> wanted_stddev) {
  session_.forgetMotion();
  stored_windows_.clear();
  waiting_windows_.clear();
  intake_.forgetMotion();
  motion_.forget(wanted_stddev);
  if (wanted_stddev) {
    private_node_.setParam(kMotionWish, *wanted_stddev);
  } else {
    private_node_.deleteParam(kMotionWish);
  }
  windows_in_a_row_ = 0;
  is_in_motion_ = false;
}

void CalibrationNode::takeUpMotion() {
  try {
    stored_windows_ = session_.motionWindows();
    if (!stored_windows_.empty()) {
      motion_.forget(options_.motion_wish);
    }
    intake_.restoreMotion(stored_windows_);
  } catch (const std::exception& error) {
    last_error_ = printable(error.what());
    ROS_WARN_STREAM("The motion of before is not taken up: " << last_error_);
  }
}

// Windows are taken under the mutex, so that none of before comes after a motion was forgotten.
void CalibrationNode::followMotion() {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  try {
    const std::vector<MotionSlice> stored = std::exchange(stored_windows_, {});
    std::vector<MotionSlice> windows = intake_.takeWindows();
    waiting_windows_.insert(waiting_windows_.end(), windows.begin(), windows.end());
    storeWaitingWindows();
    const std::size_t count = windows.size();
    for (const MotionSlice& window : stored) {
      motion_.add(window);
    }
    for (MotionSlice& window : windows) {
      motion_.add(std::move(window));
    }
    noteMotion(count);
    if (!stored.empty()) {
      publishStatus();
    }
  } catch (const std::exception& error) {
    last_error_ = printable(error.what());
    constexpr double kSilence = 10.0;  // [s]
    ROS_ERROR_STREAM_THROTTLE(kSilence, "The motion cannot be followed: " << last_error_);
  }
}

// A rotor that a hand turns from pose to pose with a coil on is in no motion.
void CalibrationNode::noteMotion(std::size_t windows) {
  constexpr double kLeast = 2.0;  // [s] of windows
  constexpr double kRest = 1.5;   // [s]
  const double now = steadySeconds();
  if (windows > 0) {
    windows_in_a_row_ += windows;
    last_window_ = now;
  } else if (now - last_window_ > kRest) {
    windows_in_a_row_ = 0;
  }
  const bool is_in_motion =
      static_cast<double>(windows_in_a_row_) * MotionOptions().window >= kLeast;
  if (is_in_motion != is_in_motion_) {
    is_in_motion_ = is_in_motion;
    publishStatus();
  }
}

std::string CalibrationNode::motionStep(const SessionProgress& progress) const {
  if (is_in_motion_) {
    return "A motion goes on: let it end, then call calibrate_motion.";
  }
  if (!motion_.canBeJudged() || progress.hasTorques() || progress.isAllIdentified()) {
    return {};
  }
  if (progress.refused) {
    return "The motion was refused, and would be again: its report says what contradicts. Mend "
           "it, call forget_motion and move the rotor anew.";
  }
  const std::vector<CycleReport>& reports = session_.calibration().reports();
  return !reports.empty() && reports.back().cycle == Cycle::kMotion
             ? "The motion leaves parameters open: its report says which, and what may be amiss. "
               "Mend that, move the rotor further and call calibrate_motion again."
             : "Call calibrate_motion: a motion is recorded.";
}

/// A disk that takes nothing is no reason to be silent about a motion that goes on.
void CalibrationNode::storeWaitingWindows() {
  constexpr std::size_t kMost = 400;  // some 15 MB of the fastest streams
  if (waiting_windows_.size() > kMost) {
    waiting_windows_.erase(waiting_windows_.begin(),
                           waiting_windows_.end() - static_cast<std::ptrdiff_t>(kMost));
  }
  if (waiting_windows_.empty()) {
    return;
  }
  try {
    session_.addMotion(waiting_windows_, utcDate());
    waiting_windows_.clear();
  } catch (const std::exception& error) {
    last_error_ = printable(error.what());
    constexpr double kSilence = 10.0;  // [s]
    ROS_ERROR_STREAM_THROTTLE(kSilence,
                              waiting_windows_.size()
                                  << " windows of a motion wait to be stored: " << last_error_);
  }
}

}  // namespace sac
