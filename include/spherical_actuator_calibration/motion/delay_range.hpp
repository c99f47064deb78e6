#pragma once

#include <vector>

namespace sac {

/// Delays of the currents against the joints that are tried before one is estimated.
struct DelayRange {
  static constexpr double kStep = 0.01;  ///< [s] a descent finds the rest of the way

  double middle = 0.0;  ///< [s]
  double reach = 0.06;  ///< [s] to both sides

  /// Ascending, with the middle among them [s].
  std::vector<double> delays() const;
};

}  // namespace sac
