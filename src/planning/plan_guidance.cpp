#include "spherical_actuator_calibration/planning/plan_guidance.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/planning/planned_pose.hpp"
#include "spherical_actuator_calibration/planning/pose_plan.hpp"

namespace sac {
namespace {

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

/// How far a plan may be from the best one, by a bound that no plan is below.
std::string distanceInWords(double stddev, double bound) {
  constexpr double kNear = 1.1;  // a larger ratio says little: the bound may be too low
  if (stddev > kNear * bound) {
    return format(
        " No plan of as many poses and torques could reach less than %.3g mrad; whether any comes "
        "nearer to that is not known.",
        1e3 * bound);
  }
  return format(
      " That is within %.1f %% of what any plan of as many poses and torques could reach.",
      std::max(0.0, 100.0 * (stddev / bound - 1.0)));
}

}  // namespace

bool PlanProgress::add(const Sample& sample) {
  bool is_more = false;
  for (PoseProgress& pose : poses_) {
    is_more = pose.add(sample, current_threshold_) || is_more;
  }
  return is_more;
}

void PlanProgress::countAnew(const std::vector<Sample>& samples) {
  for (PoseProgress& pose : poses_) {
    pose.beginAnew();
  }
  for (const Sample& sample : samples) {
    add(sample);
  }
}

std::string PlanProgress::nextStep() const {
  const auto is_measured = [](const PoseProgress& pose) { return pose.isMeasured(); };
  const auto measured = std::count_if(poses_.begin(), poses_.end(), is_measured);
  const auto next = std::find_if_not(poses_.begin(), poses_.end(), is_measured);
  if (next == poses_.end()) {
    return "";
  }
  const Eigen::Vector3d& q = next->pose().joint_position;
  const Eigen::Vector3d degrees = q / kOneDegree;
  std::string text = format(
      "Go on with the plan, %td of %s %s measured: turn the rotor to "
      "%s %.2f, %.2f, %.2f rad (%.0f, %.0f, %.0f deg) and capture%s",
      measured,
      counted(poses_.size(), "pose").c_str(),
      measured == 1 ? "is" : "are",
      has_joints_ ? "joints" : "turns about x, y, z of",
      q.x(),
      q.y(),
      q.z(),
      degrees.x(),
      degrees.y(),
      degrees.z(),
      next->pose().validation ? " (held out)" : "");
  text += excitationsInWords(next->missing());
  return text + ".";
}

std::string planSentence(const PosePlan& plan, double wanted_stddev) {
  if (plan.poses.empty()) {
    return format("No pose is needed: the samples held give a standard deviation of %.3g mrad.",
                  1e3 * plan.worst_stddev);
  }
  std::string text = format(
      "%s, %s and %s: the worst parameter, %s, is expected at a standard deviation of %.3g mrad.",
      counted(plan.poses.size(), "pose").c_str(),
      counted(plan.orientation_samples, "orientation").c_str(),
      counted(plan.torque_samples, "torque").c_str(),
      plan.worst_parameter.c_str(),
      1e3 * plan.worst_stddev);
  if (plan.stddev_bound) {
    text += distanceInWords(plan.worst_stddev, *plan.stddev_bound);
  }
  if (wanted_stddev > 0.0 && !plan.reached_wanted) {
    text += format(
        " About %zu poses are needed for %.3g mrad.", *plan.poses_needed, 1e3 * wanted_stddev);
  }
  return text;
}

std::string openSentence(const PosePlan& plan) {
  constexpr std::size_t kNamed = 4;
  std::size_t open = 0;
  std::string names;
  for (const ParameterEstimate& estimate : plan.expected) {
    if (estimate.observable) {
      continue;
    }
    if (++open <= kNamed) {
      names += (open == 1 ? "" : ", ") + estimate.name;
    }
  }
  if (open == 0 || open == plan.expected.size()) {
    return "The planned samples do not determine everything: further poses are needed.";
  }
  return format(
      "The planned samples do not determine everything, %zu of %zu parameters stay open "
      "(%s%s): further poses are needed.",
      open,
      plan.expected.size(),
      names.c_str(),
      open > kNamed ? ", ..." : "");
}

}  // namespace sac
