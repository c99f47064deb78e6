#include "coil_exciter.hpp"

#include "spherical_actuator_calibration/CoilCurrents.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/node/wall_stamp.hpp"

namespace sac {
namespace {

constexpr double kRate = 50.0;  // [Hz]

ros::Publisher advertised(ros::NodeHandle node) {
  return node.advertise<msg::CoilCurrents>("coil_command", 1);
}

}  // namespace

CoilExciter::CoilExciter(const ros::NodeHandle& node)
    : publisher_(advertised(node)), thread_(kRate, [this] { beat(); }) {}

CoilExciter::~CoilExciter() {
  thread_.stop();
  stop();
}

void CoilExciter::excite(std::uint32_t coil, std::size_t coils, double current, double seconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool was_excited = coil_ != 0;
  coil_ = coil;
  current_ = current;
  end_ = steadySeconds() + seconds;
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
  if (steadySeconds() > end_) {
    coil_ = 0;
  }
  publish();
}

void CoilExciter::publish() const {
  msg::CoilCurrents message;
  message.header.stamp = wallStamp();
  message.current.assign(coils_, 0.0);
  if (coil_ != 0 && coil_ <= coils_) {
    message.current[coil_ - 1] = current_;
  }
  publisher_.publish(message);
}

}  // namespace sac
