#include "plan_sentence.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

/// 1 pose, 2 poses.
std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

std::string planSentence(const PosePlan& plan, const PosePlanOptions& options) {
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
    text +=
        format(" That is within %.1f %% of what any plan of as many poses and torques could reach.",
               std::max(0.0, 100.0 * (plan.worst_stddev / *plan.stddev_bound - 1.0)));
  }
  if (options.wanted_stddev > 0.0 && !plan.reached_wanted) {
    text += format(" About %zu poses are needed for %.3g mrad.",
                   *plan.poses_needed,
                   1e3 * options.wanted_stddev);
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
