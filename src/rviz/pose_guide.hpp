#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <actionlib_msgs/GoalStatusArray.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <sensor_msgs/JointState.h>

#include "spherical_actuator_calibration/PlanProgress.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// Whether coils and poses are to be had, or a guided session works with them.
enum class Bench { kFree, kInSession };

/// Leads a hand through the plan in force: which pose is next, how far the rotor is from it, and
/// what the calibration node says is missing there. Knows no windows.
class PoseGuide {
 public:
  /// Joint angles that differ by at most this from those of a pose are at it [rad], by
  /// CalibrationStatus.
  void judgeBy(double tolerance) { tolerance_ = tolerance; }
  /// As the description names the joints; joint_1..3 by default.
  void nameJoints(const std::array<std::string, 3>& names) { names_ = names; }
  /// The rotor has no joints: poses are turns about x, then y, then z of the stator, and
  /// orientations tell where it is.
  void followOrientations();
  const std::array<std::string, 3>& jointNames() const { return names_; }

  /// The plan in force, and what of it is measured, instead of what was so before.
  void receive(const msg::PlanProgress& message) { poses_ = message.poses; }
  /// Joint angles [rad] by their names; a message that lacks one tells nothing.
  void receive(const sensor_msgs::JointState& message);
  /// Orientation of a rotor without joints; of another one it tells nothing here.
  void receive(const geometry_msgs::QuaternionStamped& message);

  /// The goals of the engine's sessions, instead of what was so before.
  void receive(const actionlib_msgs::GoalStatusArray& message);

  bool hasPlan() const { return !poses_.empty(); }
  /// A guided session shows by itself the pose that is next.
  Bench bench() const { return bench_; }
  /// Index of the first pose that is not measured; nothing where none is left.
  std::optional<std::size_t> next() const;
  /// Joint angles of that pose [rad].
  std::optional<std::array<double, 3>> target() const;
  /// Index of the pose where the rotor is; the first that is not measured, if there are several.
  std::optional<std::size_t> here() const;
  /// What of a pose is measured.
  const msg::PoseProgress& pose(std::size_t index) const { return poses_.at(index); }
  /// What to do, in words: "Pose 2 of 8: turn joint_1 by +12.3°, joint_3 by −4.0°."
  std::string advice() const;

 private:
  bool isThere(const msg::PoseProgress& pose) const;

  double tolerance_ = 0.0;  ///< [rad]
  std::array<std::string, 3> names_ = {"joint_1", "joint_2", "joint_3"};
  bool has_joints_ = true;
  Bench bench_ = Bench::kFree;
  std::vector<msg::PoseProgress> poses_;
  std::optional<std::array<double, 3>> joints_;
};

}  // namespace sac
