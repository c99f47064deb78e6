#include "pose_guide.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iterator>

#include <Eigen/Geometry>

#include "signed_degrees.hpp"
#include "spherical_actuator_calibration/base/angle_difference.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/turns.hpp"

namespace sac {
namespace {

/// Of a unit quaternion.
std::array<double, 3> turnsOf(const geometry_msgs::Quaternion& q) {
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  const Eigen::Vector3d turns = sac::turnsOf(rotation.normalized().toRotationMatrix());
  return {turns[0], turns[1], turns[2]};
}

std::array<double, 3> jointsOf(const msg::PoseProgress& pose) {
  std::array<double, 3> joints = {};
  std::copy(pose.pose.joint_position.begin(), pose.pose.joint_position.end(), joints.begin());
  return joints;
}

/// "coil 2, 5"; "coils +1 −4, +2 +3".
std::string listed(const std::vector<msg::CoilPattern>& patterns) {
  const bool is_single = std::all_of(patterns.begin(), patterns.end(), [](const auto& pattern) {
    return pattern.coils.size() == 1 && pattern.coils.front() > 0;
  });
  std::string text;
  for (const msg::CoilPattern& pattern : patterns) {
    text += text.empty() ? "" : ",";
    for (const std::int32_t coil : pattern.coils) {
      text += (is_single  ? " "
               : coil < 0 ? " −"
                          : " +") +
              std::to_string(std::abs(static_cast<std::int64_t>(coil)));
    }
  }
  return (is_single ? "coil" : "coils") + text;
}

}  // namespace

void PoseGuide::followOrientations() {
  has_joints_ = false;
  names_ = {"rotation_x", "rotation_y", "rotation_z"};
}

void PoseGuide::receive(const geometry_msgs::QuaternionStamped& message) {
  const geometry_msgs::Quaternion& q = message.quaternion;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!has_joints_ && std::abs(norm - 1.0) <= kUnitTolerance) {
    joints_ = turnsOf(q);
  }
}

void PoseGuide::receive(const sensor_msgs::JointState& message) {
  std::array<double, 3> joints = {};
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const auto named = std::find(message.name.begin(), message.name.end(), names_[k]);
    const auto place = static_cast<std::size_t>(std::distance(message.name.begin(), named));
    if (place >= message.position.size() || !std::isfinite(message.position[place])) {
      return;
    }
    joints[k] = message.position[place];
  }
  joints_ = joints;
}

void PoseGuide::receive(const actionlib_msgs::GoalStatusArray& message) {
  using actionlib_msgs::GoalStatus;
  const auto& goals = message.status_list;
  const bool works = std::any_of(goals.begin(), goals.end(), [](const GoalStatus& goal) {
    return goal.status == GoalStatus::PENDING || goal.status == GoalStatus::ACTIVE ||
           goal.status == GoalStatus::PREEMPTING || goal.status == GoalStatus::RECALLING;
  });
  bench_ = works ? Bench::kInSession : Bench::kFree;
}

bool PoseGuide::isThere(const msg::PoseProgress& pose) const {
  const std::array<double, 3> wanted = jointsOf(pose);
  return joints_ &&
         std::equal(wanted.begin(), wanted.end(), joints_->begin(), [this](double a, double b) {
           return std::abs(angleDifference(a, b)) <= tolerance_;
         });
}

std::optional<std::size_t> PoseGuide::next() const {
  const auto next = std::find_if(poses_.begin(), poses_.end(), [](const msg::PoseProgress& pose) {
    return pose.is_measured == 0;
  });
  return next == poses_.end()
             ? std::nullopt
             : std::make_optional<std::size_t>(std::distance(poses_.begin(), next));
}

std::optional<std::array<double, 3>> PoseGuide::target() const {
  const std::optional<std::size_t> pose = next();
  return pose ? std::make_optional(jointsOf(poses_[*pose])) : std::nullopt;
}

std::optional<std::size_t> PoseGuide::here() const {
  std::optional<std::size_t> measured;
  for (std::size_t n = 0; n < poses_.size(); ++n) {
    if (!isThere(poses_[n])) {
      continue;
    }
    if (poses_[n].is_measured == 0) {
      return n;
    }
    measured = measured.value_or(n);
  }
  return measured;
}

std::string PoseGuide::advice() const {
  if (!hasPlan()) {
    return "Plan poses to be led from one to the next.";
  }
  const std::optional<std::size_t> next = this->next();
  if (!next) {
    // What to do then tells the status: by what they were measured for may be known already.
    return poses_.size() == 1 ? "The one pose is measured."
                              : "All " + std::to_string(poses_.size()) + " poses are measured.";
  }
  const msg::PoseProgress& pose = poses_[*next];
  const std::string which = "Pose " + std::to_string(numberOf(*next)) + " of " +
                            std::to_string(poses_.size()) +
                            (pose.pose.validation != 0 ? ", held out: " : ": ");
  if (!joints_) {
    return which + (has_joints_ ? "the joint angles are silent." : "the tracker is silent.");
  }
  if (isThere(pose)) {
    return which + "there. Clamp the rotor, then measure" +
           (pose.missing.empty() ? "." : "; it excites " + listed(pose.missing) + " in turn.");
  }
  const std::array<double, 3> wanted = jointsOf(pose);
  std::string turns;
  for (std::size_t k = 0; k < joints_->size(); ++k) {
    const double left = angleDifference(wanted[k], (*joints_)[k]);
    if (std::abs(left) > tolerance_) {
      turns += (turns.empty() ? "" : ", ") + names_[k] + " by " + signedDegrees(left);
    }
  }
  return which + "turn " + turns + ".";
}

}  // namespace sac
