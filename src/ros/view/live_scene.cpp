#include "spherical_actuator_calibration/ros/view/live_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {
namespace {

/// Change of a current [A] that is worth new markers.
constexpr double kVisibleCurrent = 0.02;

bool isVisibleChange(const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
  return before.size() != now.size() || !((before - now).cwiseAbs().maxCoeff() < kVisibleCurrent);
}

/// Of the worse direction of each axis; none where an angle is not identified.
template <typename Axes>
std::vector<std::optional<double>> stddevsOf(const Axes& axes) {
  std::vector<std::optional<double>> stddevs;
  for (const auto& axis : axes) {
    const double stddev = std::max(axis.polar_stddev, std::cos(axis.polar) * axis.azimuth_stddev);
    stddevs.push_back(std::isfinite(stddev) ? std::optional(stddev) : std::nullopt);
  }
  return stddevs;
}

}  // namespace

LiveScene::LiveScene(CalibrationScene start)
    : scene_(std::move(start)), samples_(scene_.nominal.coils.size()) {
  scene_.identified = scene_.nominal;
}

void LiveScene::receive(const msg::ActuatorParameters& message) {
  const std::optional<Actuator> actuator = actuatorFromRos(message, scene_.nominal);
  if (!actuator) {
    return;
  }
  scene_.identified = *actuator;
  scene_.pole_stddevs = stddevsOf(message.poles);
  scene_.coil_stddevs = stddevsOf(message.coils);
  changed_ = true;
}

void LiveScene::receive(const msg::CalibrationReport& message) {
  residuals_.clear();
  changed_ = true;
  if (message.cycle == msg::CalibrationReport::MOTION) {  // of its windows
    return;
  }
  // A sample may have two, of its orientation and its torque: the worse one is shown.
  for (const auto& residual : message.residuals) {
    Residual& shown = residuals_[residual.id];
    shown.standardized = std::max(shown.standardized, residual.standardized);
    shown.rejected = shown.rejected || residual.rejected != 0;
  }
}

void LiveScene::receive(const msg::CoilCurrents& message) {
  Eigen::VectorXd currents = Eigen::Map<const Eigen::VectorXd>(
      message.current.data(), static_cast<Eigen::Index>(message.current.size()));
  if (message.current.size() == scene_.nominal.coils.size() &&
      isVisibleChange(scene_.currents, currents)) {
    scene_.currents = std::move(currents);
    changed_ = true;
  }
}

void LiveScene::receive(const msg::CalibrationSample& message) {
  samples_.receive(message);
}

void LiveScene::receive(const msg::CalibrationStatus& message) {
  samples_.receive(message);
}

void LiveScene::receive(const sensor_msgs::JointState& message) {
  std::optional<Eigen::Vector3d> wanted;
  if (message.position.size() == kJoints) {
    wanted = Eigen::Vector3d(message.position.data());
  }
  if ((wanted && !wanted->allFinite()) || message.header.stamp < wanted_stamp_) {
    return;
  }
  wanted_stamp_ = message.header.stamp;
  changed_ = changed_ || wanted != scene_.wanted_joint_position;
  scene_.wanted_joint_position = wanted;
}

bool LiveScene::takeChange() {
  const bool have_samples_changed = samples_.takeChange();
  return std::exchange(changed_, false) || have_samples_changed;
}

SampledDirection LiveScene::directionOf(const msg::CalibrationSample& sample) const {
  SampledDirection direction;
  if (sample.has_orientation != 0) {
    direction.direction_stator =
        quaternionFromRos(sample.orientation).normalized() * Eigen::Vector3d::UnitZ();
  } else {
    const Eigen::Vector3d q(sample.joint_position.data());
    direction.direction_stator =
        rotorOrientation(jointGeometry(scene_.identified), q) * Eigen::Vector3d::UnitZ();
  }
  const auto residual = residuals_.find(sample.id);
  if (residual != residuals_.end()) {
    direction.standardized = residual->second.standardized;
    direction.rejected = residual->second.rejected;
  }
  return direction;
}

CalibrationScene LiveScene::scene() const {
  CalibrationScene scene = scene_;
  for (const auto& [id, sample] : samples_.samples()) {
    const SampledDirection direction = directionOf(sample);
    if (direction.direction_stator.allFinite()) {
      scene.samples.push_back(direction);
    }
  }
  return scene;
}

}  // namespace sac
