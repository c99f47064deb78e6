#include "spherical_actuator_calibration/emulation/positioning_fixture.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// Longer steps are taken in parts, so that the way hardly depends on them [s].
constexpr double kLongestStep = 1e-3;

}  // namespace

void validate(const FixtureOptions& options) {
  requireInRange("fixture speed", options.speed, ValueRange::positive("rad/s"));
  requireInRange("fixture acceleration", options.acceleration, ValueRange::positive("rad/s²"));
}

PositioningFixture::PositioningFixture(const FixtureOptions& options, const Eigen::Vector3d& start)
    : options_(options), position_(start), target_(start) {
  validate(options);
}

void PositioningFixture::hold(const Eigen::Vector3d& position) {
  position_ = position;
  target_ = position;
  velocity_.setZero();
}

void PositioningFixture::advance(double step) {
  if (isAtRest()) {
    return;
  }
  const auto parts = static_cast<int>(std::ceil(step / kLongestStep));
  for (int part = 0; part < parts; ++part) {
    for (Eigen::Index joint = 0; joint < position_.size(); ++joint) {
      advanceJoint(joint, step / parts);
    }
  }
}

/// As fast as allowed, and no faster than it can still stop at the target.
void PositioningFixture::advanceJoint(Eigen::Index joint, double step) {
  const double way = target_[joint] - position_[joint];
  const double change = options_.acceleration * step;
  double& velocity = velocity_[joint];
  if (std::abs(way) <= change * step && std::abs(velocity) <= 2.0 * change) {
    position_[joint] = target_[joint];
    velocity = 0.0;
    return;
  }
  const double stopping = std::sqrt(2.0 * options_.acceleration * std::abs(way));
  const double wanted =
      std::copysign(std::min({options_.speed, stopping, std::abs(way) / step}), way);
  velocity += std::clamp(wanted - velocity, -change, change);
  position_[joint] += velocity * step;
}

}  // namespace sac
