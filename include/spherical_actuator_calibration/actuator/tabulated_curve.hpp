#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/actuator/torque_curve.hpp"

namespace sac {

/// A torque curve for those who ask very often, in less time: h(κ) of TorqueCurve::safe() by a
/// cubic through its values and slopes at evenly spaced κ (doc/method.md, Torque curve). h is right
/// to 1e-8 of its largest value, to 1e-5 next to an angle where the curve changes its form. dh is
/// the derivative of that h.
class TabulatedCurve {
 public:
  explicit TabulatedCurve(const TorqueCurve& curve);

  /// h and dh/dκ at κ = cos ψ, that of cosSupportEnd() or more.
  TorqueCurve::Safe at(double kappa) const;

 private:
  struct Node {
    double h = 0.0;
    double rise = 0.0;  ///< dh over an interval
  };

  double first_;  ///< κ of the first node
  double per_kappa_;
  std::vector<Node> nodes_;
};

inline TorqueCurve::Safe TabulatedCurve::at(double kappa) const {
  // Cosines of unit axes may be beyond 1 by rounding.
  const double place = (std::clamp(kappa, first_, 1.0) - first_) * per_kappa_;
  const std::size_t n = std::min(static_cast<std::size_t>(place), nodes_.size() - 2);
  const double t = place - static_cast<double>(n);
  const Node& from = nodes_[n];
  const Node& to = nodes_[n + 1];
  const double step = to.h - from.h;
  const double bend = 3.0 * step - 2.0 * from.rise - to.rise;
  const double twist = from.rise + to.rise - 2.0 * step;
  return {from.h + t * (from.rise + t * (bend + t * twist)),
          per_kappa_ * (from.rise + t * (2.0 * bend + 3.0 * t * twist))};
}

}  // namespace sac
