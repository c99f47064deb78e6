#include "coil_exciter.hpp"

#include "spherical_actuator_calibration/CoilCurrents.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {
namespace {

constexpr double kPeriod = 0.02;  // [s]

ros::Publisher advertised(ros::NodeHandle node) {
  return node.advertise<msg::CoilCurrents>("coil_command", 1);
}

}  // namespace

CoilExciter::CoilExciter(const ros::NodeHandle& node)
    : publisher_(advertised(node)), thread_(1, &queue_) {
  ros::NodeHandle handle = node;
  handle.setCallbackQueue(&queue_);
  timer_ = handle.createWallTimer(ros::WallDuration(kPeriod),
                                  [this](const ros::WallTimerEvent& /*event*/) { beat(); });
  thread_.start();
}

CoilExciter::~CoilExciter() {
  thread_.stop();
  stop();
}

void CoilExciter::excite(std::uint32_t coil, std::size_t coils, double current, double seconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool was_excited = coil_ != 0;
  coil_ = coil;
  current_ = current;
  end_ = ros::SteadyTime::now() + ros::WallDuration(seconds);
  if (coil != 0) {
    coils_ = coils;
  }
  if (coil != 0 || was_excited) {
    publish();
  }
}

std::uint32_t CoilExciter::coil() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return coil_;
}

void CoilExciter::beat() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (coil_ == 0) {
    return;
  }
  if (ros::SteadyTime::now() > end_) {
    coil_ = 0;
  }
  publish();
}

void CoilExciter::publish() const {
  msg::CoilCurrents message;
  // Coils are real, whatever /use_sim_time says.
  const ros::WallTime now = ros::WallTime::now();
  message.header.stamp = ros::Time(now.sec, now.nsec);
  message.current.assign(coils_, 0.0);
  if (coil_ != 0 && coil_ <= coils_) {
    message.current[coil_ - 1] = current_;
  }
  publisher_.publish(message);
}

}  // namespace sac
