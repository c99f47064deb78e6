#include "held_out_outliers.hpp"

#include <algorithm>
#include <map>

#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {
namespace {

/// Whether so many outliers among `count` are no more than the rate of those elsewhere.
bool areUsual(std::size_t outliers, std::size_t count, double rate, double most) {
  if (outliers == 0 || static_cast<double>(outliers) > most * static_cast<double>(count)) {
    return outliers == 0;
  }
  return binomialTail(count, rate, outliers) >= kLeastProbability;
}

/// Held-out torques of a coil that the test counts.
struct HeldOutTorques {
  std::vector<std::size_t> set_aside;        ///< measurements
  std::optional<std::size_t> last_agreeing;  ///< its place among all samples
};

std::map<std::size_t, HeldOutTorques> torquesByCoil(
    const std::vector<HeldOutMeasurement>& measurements, const std::vector<bool>& set_aside) {
  std::map<std::size_t, HeldOutTorques> torques;
  for (std::size_t n = 0; n < measurements.size(); ++n) {
    for (const std::size_t coil : measurements[n].coils) {
      HeldOutTorques& own = torques[coil];
      if (set_aside[n]) {
        own.set_aside.push_back(n);
      } else if (measurements[n].counts) {
        own.last_agreeing = std::max(own.last_agreeing, std::optional(measurements[n].sample));
      }
    }
  }
  return torques;
}

/// Torques of a coil that stand out since the last one that agreed.
struct Newest {
  std::vector<std::size_t> held_out;  ///< measurements
  std::size_t in_use = 0;
};

Newest newestOf(const std::vector<HeldOutMeasurement>& measurements,
                const HeldOutTorques& torques,
                const TorquesInUse& in_use) {
  const auto agreeing = std::max(torques.last_agreeing, in_use.last_agreeing);
  Newest newest;
  for (const std::size_t n : torques.set_aside) {
    if (std::optional(measurements[n].sample) > agreeing) {
      newest.held_out.push_back(n);
    }
  }
  newest.in_use = static_cast<std::size_t>(
      std::count_if(in_use.rejected.begin(), in_use.rejected.end(), [&](std::size_t sample) {
        return std::optional(sample) > agreeing;
      }));
  return newest;
}

TorquesInUse ofCoil(std::size_t coil, const std::map<std::size_t, TorquesInUse>& in_use) {
  const auto found = in_use.find(coil);
  return found == in_use.end() ? TorquesInUse() : found->second;
}

}  // namespace

OutlierChoice chooseOutliers(const std::vector<HeldOutMeasurement>& measurements,
                             const std::vector<std::size_t>& standing_out,
                             const std::map<std::size_t, TorquesInUse>& in_use,
                             double rate,
                             double most) {
  OutlierChoice choice;
  choice.set_aside.assign(measurements.size(), false);
  const auto counted = std::count_if(measurements.begin(),
                                     measurements.end(),
                                     [](const HeldOutMeasurement& one) { return one.counts; });
  if (!areUsual(standing_out.size(), static_cast<std::size_t>(counted), rate, most)) {
    return choice;
  }
  for (const std::size_t n : standing_out) {
    choice.set_aside[n] = true;
  }
  for (const auto& [coil, torques] : torquesByCoil(measurements, choice.set_aside)) {
    const Newest newest = newestOf(measurements, torques, ofCoil(coil, in_use));
    if (!newest.held_out.empty() && newest.held_out.size() + newest.in_use > 1) {
      choice.changed_coils[coil] = newest.held_out;
    }
  }
  for (const auto& [coil, stay] : choice.changed_coils) {
    for (const std::size_t n : stay) {
      choice.set_aside[n] = false;
    }
  }
  for (const auto& [coil, torques] : torquesByCoil(measurements, choice.set_aside)) {
    if (!torques.set_aside.empty() && !torques.last_agreeing) {
      choice.undecided_coils.push_back(coil);
    }
    if (!newestOf(measurements, torques, ofCoil(coil, in_use)).held_out.empty()) {
      choice.doubtful_coils.push_back(coil);
    }
  }
  choice.count =
      static_cast<std::size_t>(std::count(choice.set_aside.begin(), choice.set_aside.end(), true));
  return choice;
}

}  // namespace sac
