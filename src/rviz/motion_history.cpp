#include "motion_history.hpp"

#include <cmath>
#include <cstddef>

#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
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
  if (last_.message.empty()) {
    return "The node calibration tells of no motion.";
  }
  const std::string words = printable(last_.message);
  return last_.told == 0
             ? words
             : words + format(" Misfit over noise, squared: %.2f.", last_.reduced_chi_square);
}

std::vector<std::string> MotionHistory::dynamics() const {
  std::vector<std::string> lines;
  for (const msg::ParameterEstimate& one : last_.dynamics) {
    if (one.observable != 0) {
      lines.push_back(printable(one.name) + format(" = %.4g ± %.1g ", one.value, one.stddev) +
                      printable(one.unit));
    }
  }
  return lines;
}

}  // namespace sac
