#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <geometry_msgs/QuaternionStamped.h>
#include <sensor_msgs/JointState.h>

#include "spherical_actuator_calibration/CalibrationSample.h"
#include "spherical_actuator_calibration/PlannedPose.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// Leads a hand to planned poses: which is next, how far the rotor is from it, and what has not
/// been measured there. Knows no windows.
class PoseGuide {
 public:
  /// The rule of the calibration node (CalibrationStatus): joint angles that differ by at most
  /// `tolerance` [rad] are the same pose, a coil below `threshold` [A] is off.
  void judgeBy(double tolerance, double threshold);
  /// As the description names the joints; joint_1..3 by default.
  void nameJoints(const std::array<std::string, 3>& names) { names_ = names; }
  /// The rotor has no joints: poses are turns about x, then y, then z of the stator, and
  /// orientations tell where it is.
  void followOrientations();
  const std::array<std::string, 3>& jointNames() const { return names_; }

  /// Poses to measure at, in their order, instead of those before.
  void take(const std::vector<msg::PlannedPose>& poses);
  /// Joint angles [rad]: by their names, or the first three where there are none.
  void receive(const sensor_msgs::JointState& message);
  /// Orientation of a rotor without joints; of another one it tells nothing here.
  void receive(const geometry_msgs::QuaternionStamped& message);
  /// A sample that is held, to judge or not: its pose and pattern are measured, and with the
  /// pattern its opposite, which tells the same.
  void receive(const msg::CalibrationSample& sample);

  /// All that is to be measured at a pose is held, whoever measured it.
  void noteMeasured(std::size_t pose);

  bool hasPlan() const { return !poses_.empty(); }
  /// Index of the first pose that is not measured; nothing where none is left.
  std::optional<std::size_t> next() const;
  /// Joint angles of that pose [rad].
  std::optional<std::array<double, 3>> target() const;
  /// Index of the pose where the rotor is; the first that is not measured, if there are several.
  std::optional<std::size_t> here() const;
  /// Joint angles of a pose [rad].
  const std::array<double, 3>& joints(std::size_t pose) const { return poses_.at(pose).joints; }
  /// Coils to excite at a pose that no sample holds yet, counted from 1, in turn; 0: without
  /// current, which comes first. None where all coils are measured, and anything at all.
  std::vector<std::uint32_t> missing(std::size_t pose) const;
  /// What to do, in words: "Pose 2 of 8: turn joint_1 by +12.3°, joint_3 by −4.0°."
  std::string advice() const;

 private:
  struct Pose {
    std::array<double, 3> joints = {};
    std::vector<std::uint32_t> coils;
    std::set<std::uint32_t> measured;
    bool has_sample = false;
  };

  bool isSame(const std::array<double, 3>& one, const std::array<double, 3>& other) const;
  /// The coil that currents [A] excite, counted from 1; 0: none; nothing: several.
  std::optional<std::uint32_t> excitedCoil(const std::vector<double>& currents) const;

  double tolerance_ = 0.0;  ///< [rad]
  double threshold_ = 0.0;  ///< [A]
  std::array<std::string, 3> names_ = {"joint_1", "joint_2", "joint_3"};
  bool has_joints_ = true;
  std::vector<Pose> poses_;
  std::optional<std::array<double, 3>> joints_;
};

}  // namespace sac
