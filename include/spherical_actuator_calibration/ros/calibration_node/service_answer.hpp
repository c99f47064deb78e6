#pragma once

#include <exception>
#include <mutex>
#include <string>

#include <ros/console.h>

#include "spherical_actuator_calibration/base/printable_text.hpp"

namespace sac {

/// Answers a service under a mutex: `action` returns the message of success; what it throws becomes
/// that of failure, is logged, and is kept as the last error.
template <typename Response, typename Action>
void answerService(std::mutex& mutex, std::string& last_error, Response& response, Action action) {
  const std::lock_guard<std::mutex> lock(mutex);
  try {
    response.message = action();
    response.success = 1;
  } catch (const std::exception& error) {
    response.success = 0;
    response.message = printable(error.what());
    last_error = response.message;
    ROS_ERROR_STREAM(last_error);
  }
}

}  // namespace sac
