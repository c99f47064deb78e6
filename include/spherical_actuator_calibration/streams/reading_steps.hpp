#pragma once

#include <optional>

namespace sac {

/// Resolution of a sensor, from its readings alone: the largest step that all of their differences
/// are multiples of. Noise and motion that are finer than the steps leave none.
class ReadingSteps {
 public:
  /// Finite [rad].
  void add(double reading);

  /// 0 while there is none [rad]: too few differences so far, or finer than anybody will notice.
  double step() const;

 private:
  std::optional<double> previous_;
  double divisor_ = 0.0;  ///< greatest common one of the differences so far
  int differences_ = 0;
};

}  // namespace sac
