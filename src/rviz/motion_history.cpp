#include "motion_history.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>

#include "spherical_actuator_calibration/base/printable_text.hpp"

namespace sac {
namespace {

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

void MotionHistory::receive(const msg::MotionProgress& message) {
  // Another motion, or a motion of another unit.
  const bool begins_anew =
      message.windows < last_.windows || message.groups.size() != curves_.size();
  if (begins_anew) {
    curves_.clear();
    for (const msg::GroupUncertainty& group : message.groups) {
      curves_.push_back({group.group, {}, {}});
    }
  }
  last_ = message;
  for (std::size_t n = 0; message.told != 0 && n < curves_.size(); ++n) {
    UncertaintyCurve& curve = curves_[n];
    const double stddev = message.groups[n].stddev;
    const bool is_new = curve.seconds.empty() || message.duration > curve.seconds.back();
    if (is_new && std::isfinite(message.duration) && std::isfinite(stddev) && stddev > 0.0) {
      curve.seconds.push_back(message.duration);
      curve.stddevs.push_back(stddev);
    }
  }
  thin();
}

/// Every second place of a long motion: a picture has no more.
void MotionHistory::thin() {
  constexpr std::size_t kMost = 4000;
  for (UncertaintyCurve& curve : curves_) {
    if (curve.seconds.size() > kMost) {
      for (std::size_t n = 0; 2 * n < curve.seconds.size(); ++n) {
        curve.seconds[n] = curve.seconds[2 * n];
        curve.stddevs[n] = curve.stddevs[2 * n];
      }
      curve.seconds.resize((curve.seconds.size() + 1) / 2);
      curve.stddevs.resize(curve.seconds.size());
    }
  }
}

std::string MotionHistory::words() const {
  if (last_.windows == 0) {
    return "No motion yet: let the rotor follow a plan, by run_motion or calibrate_by_motion.";
  }
  if (last_.told == 0) {
    return formatted("%u windows of motion: the first estimate is to come.", last_.windows);
  }
  std::string words = formatted("%.1f s of motion", last_.duration);
  if (last_.left_out > 0) {
    words += formatted(", %u of %u windows left out", last_.left_out, last_.windows);
  }
  words += formatted("; misfit over noise, squared: %.2f. ", last_.reduced_chi_square);
  std::string left;
  for (const msg::GroupUncertainty& group : last_.groups) {
    if (group.left > 0) {
      left += formatted("%s%u of %u ", left.empty() ? "" : ", ", group.left, group.parameters) +
              printable(group.group) + " (" + printable(group.least_known) +
              formatted(": %.3f mrad)", kMilli * group.stddev);
    }
  }
  const std::string wanted = formatted("%.3f mrad", kMilli * last_.wanted_stddev);
  if (left.empty()) {
    return words + "All joints, poles and coils are known to " + wanted + ".";
  }
  words += "Left to " + wanted + ": " + left;
  return last_.time_left < 0.0
             ? words + "."
             : words + formatted(", some %.0f s more.", std::ceil(last_.time_left));
}

std::vector<std::string> MotionHistory::dynamics() const {
  std::vector<std::string> lines;
  for (const msg::ParameterEstimate& one : last_.dynamics) {
    if (one.observable != 0) {
      lines.push_back(printable(one.name) + formatted(" = %.4g ± %.1g ", one.value, one.stddev) +
                      printable(one.unit));
    }
  }
  return lines;
}

}  // namespace sac
