#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "held_out_measurement.hpp"

namespace sac {

/// What samples in use tell of the torques of a coil, by their places among all samples.
struct TorquesInUse {
  std::optional<std::size_t> last_agreeing;
  std::vector<std::size_t> rejected;  ///< ascending
};

/// Which held-out measurements are set aside as outliers.
struct OutlierChoice {
  std::vector<bool> set_aside;               ///< per measurement
  std::size_t count = 0;                     ///< of these
  std::vector<std::size_t> undecided_coils;  ///< all of whose torques are set aside, ascending
  std::vector<std::size_t> doubtful_coils;   ///< whose newest torque is set aside, ascending
  /// Measurements with the newest torques of a coil that has changed.
  std::map<std::size_t, std::vector<std::size_t>> changed_coils;
};

/// Those that stand out, ascending, where they are no more than `rate` elsewhere, and at most the
/// share `most`. Where the newest torques of a coil stand out, two or more in a row with those in
/// use that were rejected, it has changed: they stay.
OutlierChoice chooseOutliers(const std::vector<HeldOutMeasurement>& measurements,
                             const std::vector<std::size_t>& standing_out,
                             const std::map<std::size_t, TorquesInUse>& in_use,
                             double rate,
                             double most);

}  // namespace sac
