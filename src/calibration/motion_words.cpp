#include "motion_words.hpp"

#include <cmath>

#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

constexpr double kMilli = 1e3;  // mrad in a rad

std::string knownOf(const std::vector<GroupUncertainty>& groups) {
  std::string words;
  for (const GroupUncertainty& group : groups) {
    words +=
        format("%s%s %.3f", words.empty() ? "" : ", ", group.group.c_str(), kMilli * group.stddev);
  }
  return words + " mrad";
}

/// "30 of 48 coils (coil_7/azimuth)"; empty where nothing is left.
std::string leftOf(const std::vector<GroupUncertainty>& groups) {
  std::string words;
  for (const GroupUncertainty& group : groups) {
    if (group.left > 0) {
      words += format("%s%u of %u %s (%s)",
                      words.empty() ? "" : ", ",
                      group.left,
                      group.parameters,
                      group.group.c_str(),
                      group.least_known.c_str());
    }
  }
  return words;
}

}  // namespace

std::string motionInWords(const LiveEstimate& estimate,
                          const std::vector<GroupUncertainty>& groups,
                          double wanted_stddev,
                          bool can_be_judged,
                          std::optional<double> time_left) {
  if (estimate.windows == 0) {
    return "No motion yet: let the rotor follow a plan, by run_motion or calibrate_by_motion.";
  }
  if (!estimate.is_told) {
    return format("%zu windows of motion: the first estimate is to come.", estimate.windows);
  }
  std::string words = format("%.0f s of motion: ", estimate.duration) + knownOf(groups);
  if (estimate.left_out > 0) {
    words += format(", %zu of %zu windows left out", estimate.left_out, estimate.windows);
  }
  const std::string left = leftOf(groups);
  const std::string wanted = format("%.3f mrad", kMilli * wanted_stddev);
  if (left.empty()) {
    return words + "; all within " + wanted +
           (can_be_judged ? "."
                          : ", by too few windows yet to hold some out, which judge the others.");
  }
  words += "; left to " + wanted + ": " + left;
  return time_left ? words + format(", some %.0f s more.", std::ceil(*time_left)) : words + ".";
}

}  // namespace sac
