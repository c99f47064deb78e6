#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sac {

/// Median of at least one value; of an even number the larger of the middle two.
inline double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace sac
