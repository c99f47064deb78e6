#include "spherical_actuator_calibration/planning/plan_guidance.hpp"

#include <algorithm>
#include <cstddef>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/planning/planned_capture.hpp"
#include "spherical_actuator_calibration/planning/planned_pose.hpp"

namespace sac {
namespace {

/// The opposite of a pattern tells the same.
bool isSame(const CoilPattern& a, CoilPattern b) {
  if (a == b) {
    return true;
  }
  for (SignedCoil& coil : b) {
    coil.sign = -coil.sign;
  }
  return a == b;
}

/// "a, b and c".
std::string enumerated(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ");
    text += words[i];
  }
  return text;
}

/// " without current, then with coil 1 and 3 excited in turn".
std::string excitationsInWords(const std::vector<CoilPattern>& patterns) {
  if (patterns.empty()) {
    return "";
  }
  const bool is_single = std::all_of(patterns.begin(), patterns.end(), [](const CoilPattern& p) {
    return p.size() == 1 && p.front().sign > 0;
  });
  std::vector<std::string> words;
  words.reserve(patterns.size());
  for (const CoilPattern& pattern : patterns) {
    words.push_back(is_single ? std::to_string(numberOf(pattern.front().coil))
                              : "(" + patternText(pattern) + ")");
  }
  return std::string(" without current, then with ") + (is_single ? "coil " : "coils ") +
         enumerated(words) + (words.size() == 1 ? " excited" : " excited in turn");
}

}  // namespace

void PlanProgress::add(const Sample& sample) {
  for (Pose& pose : poses_) {
    if (!isAtPose(sample, pose.joint_position)) {
      continue;
    }
    pose.has_sample = true;
    const CoilPattern measured = patternOf(sample, current_threshold_);
    const auto done =
        std::find_if(pose.open.begin(), pose.open.end(), [&](const CoilPattern& pattern) {
          return isSame(pattern, measured);
        });
    if (done != pose.open.end()) {
      pose.open.erase(done);
    }
  }
}

void PlanProgress::countAnew(const std::vector<Sample>& samples) {
  for (Pose& pose : poses_) {
    pose.open = pose.patterns;
    pose.has_sample = false;
  }
  for (const Sample& sample : samples) {
    add(sample);
  }
}

std::string PlanProgress::nextStep() const {
  const auto measured = std::count_if(
      poses_.begin(), poses_.end(), [](const Pose& pose) { return pose.isMeasured(); });
  const auto next = std::find_if(
      poses_.begin(), poses_.end(), [](const Pose& pose) { return !pose.isMeasured(); });
  if (next == poses_.end()) {
    return "";
  }
  const Eigen::Vector3d& q = next->joint_position;
  const Eigen::Vector3d degrees = q / kOneDegree;
  std::string text = format(
      "Go on with the plan, %td of %zu poses are measured: turn the rotor to "
      "%s %.2f, %.2f, %.2f rad (%.0f, %.0f, %.0f deg) and capture",
      measured,
      poses_.size(),
      has_joints_ ? "joints" : "turns about x, y, z of",
      q.x(),
      q.y(),
      q.z(),
      degrees.x(),
      degrees.y(),
      degrees.z());
  text += excitationsInWords(next->open);
  return text + ".";
}

std::string planStep(const std::vector<PlannedPose>& poses,
                     const std::vector<Sample>& samples,
                     double current_threshold,
                     bool has_joints) {
  PlanProgress progress(current_threshold, has_joints);
  for (const PlannedPose& pose : poses) {
    progress.addPose(pose.joint_position, pose.excitations());
  }
  progress.countAnew(samples);
  return progress.nextStep();
}

}  // namespace sac
