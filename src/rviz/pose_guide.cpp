#include "pose_guide.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

std::string inDegrees(double angle) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f°", std::abs(angle) / kOneDegree);
  return (angle < 0.0 ? "−" : "+") + std::string(text);
}

/// Of two angles [rad]; a full turn makes none.
double difference(double a, double b) {
  return std::remainder(a - b, 2.0 * kPi);
}

/// Turns about x, then y, then z [rad] of a unit quaternion.
std::array<double, 3> turnsOf(const geometry_msgs::Quaternion& q) {
  const double r12 = 2.0 * (q.y * q.z - q.w * q.x);
  const double r22 = 1.0 - 2.0 * (q.x * q.x + q.y * q.y);
  const double first = std::atan2(-r12, r22);
  const double second = std::atan2(2.0 * (q.x * q.z + q.w * q.y), std::hypot(r12, r22));
  // The second row of what is left after the first turn was taken back.
  const double sine = std::sin(first);
  const double cosine = std::cos(first);
  const double left_0 =
      cosine * 2.0 * (q.x * q.y + q.w * q.z) + sine * 2.0 * (q.x * q.z - q.w * q.y);
  const double left_1 =
      cosine * (1.0 - 2.0 * (q.x * q.x + q.z * q.z)) + sine * 2.0 * (q.y * q.z + q.w * q.x);
  return {first, second, std::atan2(left_0, left_1)};
}

std::string listed(const std::vector<std::uint32_t>& coils) {
  std::string text;
  for (const std::uint32_t coil : coils) {
    text += (text.empty() ? "" : ", ") + std::to_string(coil);
  }
  return text;
}

}  // namespace

void PoseGuide::judgeBy(double tolerance, double threshold) {
  tolerance_ = tolerance;
  threshold_ = threshold;
}

void PoseGuide::take(const std::vector<msg::PlannedPose>& poses) {
  poses_.clear();
  for (const msg::PlannedPose& planned : poses) {
    Pose pose;
    std::copy(planned.joint_position.begin(), planned.joint_position.end(), pose.joints.begin());
    pose.coils.assign(planned.coils.begin(), planned.coils.end());
    poses_.push_back(std::move(pose));
  }
}

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
    const auto place = named == message.name.end()
                           ? k
                           : static_cast<std::size_t>(std::distance(message.name.begin(), named));
    if (place >= message.position.size() || !std::isfinite(message.position[place])) {
      return;
    }
    joints[k] = message.position[place];
  }
  joints_ = joints;
}

void PoseGuide::receive(const msg::CalibrationSample& sample) {
  const std::optional<std::uint32_t> coil = excitedCoil(sample.current);
  std::array<double, 3> joints = {};
  std::copy(sample.joint_position.begin(), sample.joint_position.end(), joints.begin());
  for (Pose& pose : poses_) {
    if (!isSame(pose.joints, joints)) {
      continue;
    }
    pose.has_sample = true;
    if (coil) {
      pose.measured.insert(*coil);
    }
  }
}

void PoseGuide::noteMeasured(std::size_t pose) {
  Pose& at = poses_.at(pose);
  at.has_sample = true;
  at.measured.insert(0);
  at.measured.insert(at.coils.begin(), at.coils.end());
}

bool PoseGuide::isSame(const std::array<double, 3>& one, const std::array<double, 3>& other) const {
  return std::equal(one.begin(), one.end(), other.begin(), [this](double a, double b) {
    return std::abs(difference(a, b)) <= tolerance_;
  });
}

std::optional<std::uint32_t> PoseGuide::excitedCoil(const std::vector<double>& currents) const {
  std::uint32_t coil = 0;
  for (std::size_t j = 0; j < currents.size(); ++j) {
    if (std::abs(currents[j]) < threshold_) {
      continue;
    }
    if (coil != 0) {
      return std::nullopt;
    }
    coil = static_cast<std::uint32_t>(numberOf(j));
  }
  return coil;
}

std::vector<std::uint32_t> PoseGuide::missing(std::size_t pose) const {
  const Pose& at = poses_.at(pose);
  std::vector<std::uint32_t> result;
  std::copy_if(at.coils.begin(), at.coils.end(), std::back_inserter(result), [&](auto coil) {
    return at.measured.count(coil) == 0;
  });
  if (at.measured.count(0) == 0 && (!result.empty() || !at.has_sample)) {
    result.insert(result.begin(), 0);
  }
  return result;
}

std::optional<std::size_t> PoseGuide::next() const {
  for (std::size_t n = 0; n < poses_.size(); ++n) {
    if (!missing(n).empty()) {
      return n;
    }
  }
  return std::nullopt;
}

std::optional<std::array<double, 3>> PoseGuide::target() const {
  const std::optional<std::size_t> pose = next();
  return pose ? std::make_optional(poses_[*pose].joints) : std::nullopt;
}

std::optional<std::size_t> PoseGuide::here() const {
  std::optional<std::size_t> measured;
  for (std::size_t n = 0; joints_ && n < poses_.size(); ++n) {
    if (!isSame(poses_[n].joints, *joints_)) {
      continue;
    }
    if (!missing(n).empty()) {
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
  const std::optional<std::size_t> target = next();
  if (!target) {
    return "All " + std::to_string(poses_.size()) + " poses are measured: calibrate.";
  }
  const std::string which =
      "Pose " + std::to_string(numberOf(*target)) + " of " + std::to_string(poses_.size()) + ": ";
  if (!joints_) {
    return which + (has_joints_ ? "the joint angles are silent." : "the tracker is silent.");
  }
  if (isSame(poses_[*target].joints, *joints_)) {
    const std::vector<std::uint32_t> open = missing(*target);
    const std::vector<std::uint32_t> coils(open.begin() + (open.front() == 0 ? 1 : 0), open.end());
    return which + "there. Clamp the rotor, then measure" +
           (coils.empty() ? "." : "; it excites coil " + listed(coils) + " in turn.");
  }
  std::string turns;
  for (std::size_t k = 0; k < joints_->size(); ++k) {
    const double left = difference(poses_[*target].joints[k], (*joints_)[k]);
    if (std::abs(left) > tolerance_) {
      turns += (turns.empty() ? "" : ", ") + names_[k] + " by " + inDegrees(left);
    }
  }
  return which + "turn " + turns + ".";
}

}  // namespace sac
