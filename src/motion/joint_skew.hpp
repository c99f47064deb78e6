#pragma once

#include <Eigen/Core>

#include "motion_point.hpp"
#include "motion_span.hpp"
#include "window_balance.hpp"

namespace sac {

/// By how much later than joint 1 each of the others may be read: what all have in common the
/// delays of currents and tracker tell.
constexpr Eigen::Index kSkews = 2;

/// Derivatives of a window's residuals by each skew [per s].
class SkewEvaluator {
 public:
  /// Keeps a reference.
  explicit SkewEvaluator(const MotionOptions& options)
      // By one radian of a reading.
      : balance_(options, Eigen::Vector3d::Ones()) {}

  Eigen::MatrixXd evaluate(const MotionSpan& span,
                           const MotionWindow& window,
                           const MotionPoint& point);

 private:
  BalanceEvaluator balance_;
  WindowBalance values_;
};

}  // namespace sac
