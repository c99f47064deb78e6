#pragma once

#include <Eigen/Core>

namespace sac {

/// How fast a positioning fixture turns the joints; it stands perfectly still at its target.
struct FixtureOptions {
  double speed = 2.0;          ///< of each joint, at most [rad/s]
  double acceleration = 20.0;  ///< of each joint, at most [rad/s²]
};

/// Throws ConfigError that names the option, its value and the allowed range.
void validate(const FixtureOptions& options);

/// A device that holds the rotor and turns each joint to its target, within limits of speed and
/// acceleration.
class PositioningFixture {
 public:
  /// At rest at joint angles `start` [rad]. Throws ConfigError.
  PositioningFixture(const FixtureOptions& options, const Eigen::Vector3d& start);

  /// Joint angles to go to [rad], finite.
  void setTarget(const Eigen::Vector3d& target) { target_ = target; }
  /// Takes the rotor where it is, at rest.
  void hold(const Eigen::Vector3d& position);

  /// On by `step` ≥ 0 [s].
  void advance(double step);

  const Eigen::Vector3d& position() const { return position_; }  ///< [rad]
  bool isAtRest() const { return velocity_.isZero(0.0) && position_ == target_; }

 private:
  void advanceJoint(Eigen::Index joint, double step);

  FixtureOptions options_;
  Eigen::Vector3d position_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_;
};

}  // namespace sac
