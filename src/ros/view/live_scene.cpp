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

}  // namespace

LiveScene::LiveScene(CalibrationScene start) : scene_(std::move(start)) {
  scene_.identified = scene_.nominal;
}

void LiveScene::receive(const msg::ActuatorParameters& message) {
  const std::optional<Actuator> actuator = actuatorFromRos(message, scene_.nominal);
  if (!actuator) {
    return;
  }
  scene_.identified = *actuator;
  is_identified_ = message.source == "identified";
  // Of values that were restored the topics tell no uncertainty. A report may come before the
  // parameters that it led to, hence not at every change.
  if (!is_identified_) {
    stddevs_.clear();
  }
  changed_ = true;
}

void LiveScene::receive(const msg::CalibrationReport& message) {
  for (const auto& residual : message.residuals) {
    residuals_[residual.id] = {residual.standardized, residual.rejected != 0};
  }
  if (message.success != 0) {
    for (const auto& estimate : message.estimates) {
      if (estimate.observable != 0 && std::isfinite(estimate.stddev)) {
        stddevs_[estimate.name] = estimate.stddev;
      } else {
        stddevs_.erase(estimate.name);
      }
    }
  }
  changed_ = true;
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

bool LiveScene::takeChange() {
  const bool have_samples_changed = samples_.takeChange();
  return std::exchange(changed_, false) || have_samples_changed;
}

std::optional<double> LiveScene::stddevOf(const std::string& axis, double polar) const {
  const auto elevation = stddevs_.find(axis + "/polar");
  const auto azimuth = stddevs_.find(axis + "/azimuth");
  if (!is_identified_ || elevation == stddevs_.end() || azimuth == stddevs_.end()) {
    return std::nullopt;
  }
  return std::max(elevation->second, std::cos(polar) * azimuth->second);
}

SampledDirection LiveScene::directionOf(const msg::CalibrationSample& sample) const {
  SampledDirection direction;
  if (sample.has_orientation != 0) {
    direction.direction_stator =
        quaternionFromRos(sample.orientation).normalized() * Eigen::Vector3d::UnitZ();
  } else {
    const Eigen::Vector3d q(sample.joint_position.data());
    direction.direction_stator =
        rotorOrientation(jointGeometry(joints()), q) * Eigen::Vector3d::UnitZ();
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
  for (std::size_t i = 0; i < scene.identified.poles.size(); ++i) {
    scene.pole_stddevs.push_back(
        stddevOf("pole_" + std::to_string(i + 1), scene.identified.poles[i].polar));
  }
  for (std::size_t j = 0; j < scene.identified.coils.size(); ++j) {
    scene.coil_stddevs.push_back(
        stddevOf("coil_" + std::to_string(j + 1), scene.identified.coils[j].polar));
  }
  for (const auto& [id, sample] : samples_.samples()) {
    const SampledDirection direction = directionOf(sample);
    if (direction.direction_stator.allFinite()) {
      scene.samples.push_back(direction);
    }
  }
  return scene;
}

}  // namespace sac
