#include <cstddef>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include <ros/console.h>

#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/calibration_node/calibration_node.hpp"
#include "spherical_actuator_calibration/ros/conversion/utc_date.hpp"

namespace sac {

bool CalibrationNode::calibrateMotion(msg::Calibrate::Request& /*request*/,
                                      msg::Calibrate::Response& response) {
  const auto motion = std::make_shared<const MotionRecording>(intake_.motion());
  {
    const std::lock_guard<std::mutex> lock(session_mutex_);
    session_.setMotion(motion);
  }
  run({Cycle::kMotion}, response);
  const std::lock_guard<std::mutex> lock(session_mutex_);
  session_.setMotion(nullptr);
  return true;
}

bool CalibrationNode::forgetMotion(std_srvs::Trigger::Request& /*request*/,
                                   std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  try {
    beginMotionAnew();
    response.success = 1;
    response.message = "The next motion begins anew.";
  } catch (const std::exception& error) {
    response.message = printable(error.what());
    last_error_ = response.message;
  }
  return true;
}

void CalibrationNode::beginMotionAnew() {
  session_.forgetMotion();
  stored_windows_.clear();
  waiting_windows_.clear();
  intake_.forgetMotion();
  motion_.forget();
}

void CalibrationNode::takeUpMotion() {
  try {
    stored_windows_ = session_.motionWindows();
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
    for (const MotionSlice& window : stored) {
      motion_.add(window);
    }
    for (MotionSlice& window : windows) {
      motion_.add(std::move(window));
    }
  } catch (const std::exception& error) {
    last_error_ = printable(error.what());
    constexpr double kSilence = 10.0;  // [s]
    ROS_ERROR_STREAM_THROTTLE(kSilence, "The motion cannot be followed: " << last_error_);
  }
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
