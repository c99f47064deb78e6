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

/// Patterns of the pose that no sample there has.
std::vector<CoilPattern> openPatterns(const PlannedPose& pose,
                                      const std::vector<Sample>& samples,
                                      double current_threshold) {
  std::vector<CoilPattern> open = pose.excitations();
  for (const Sample& sample : samples) {
    if (!isAtPose(sample, pose.joint_position)) {
      continue;
    }
    const CoilPattern measured = patternOf(sample, current_threshold);
    const auto done = std::find_if(open.begin(), open.end(), [&](const CoilPattern& pattern) {
      return isSame(pattern, measured);
    });
    if (done != open.end()) {
      open.erase(done);
    }
  }
  return open;
}

bool hasSample(const PlannedPose& pose, const std::vector<Sample>& samples) {
  return std::any_of(samples.begin(), samples.end(), [&](const Sample& sample) {
    return isAtPose(sample, pose.joint_position);
  });
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

std::string planStep(const std::vector<PlannedPose>& poses,
                     const std::vector<Sample>& samples,
                     double current_threshold,
                     bool has_joints) {
  std::size_t measured = 0;
  const PlannedPose* next = nullptr;
  std::vector<CoilPattern> next_patterns;
  for (const PlannedPose& pose : poses) {
    const std::vector<CoilPattern> open = openPatterns(pose, samples, current_threshold);
    if (open.empty() && hasSample(pose, samples)) {
      ++measured;
    } else if (next == nullptr) {
      next = &pose;
      next_patterns = open;
    }
  }
  if (next == nullptr) {
    return "";
  }
  const Eigen::Vector3d& q = next->joint_position;
  const Eigen::Vector3d degrees = q / kOneDegree;
  std::string text = format(
      "Go on with the plan, %zu of %zu poses are measured: turn the rotor to "
      "%s %.2f, %.2f, %.2f rad (%.0f, %.0f, %.0f deg) and capture",
      measured,
      poses.size(),
      has_joints ? "joints" : "turns about x, y, z of",
      q.x(),
      q.y(),
      q.z(),
      degrees.x(),
      degrees.y(),
      degrees.z());
  text += excitationsInWords(next_patterns);
  return text + ".";
}

}  // namespace sac
