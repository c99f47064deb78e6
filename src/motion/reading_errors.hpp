#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "motion_point.hpp"
#include "motion_span.hpp"
#include "window_balance.hpp"

namespace sac {

/// By how much later than joint 1 each of the others may be read: what all have in common the
/// delays of currents and tracker tell.
constexpr Eigen::Index kSkews = 2;
/// Ways in which the readings of a joint may be wrong beside its offset.
constexpr Eigen::Index kReadingShapes = 2;
/// First the skews, then the shapes of each joint.
constexpr Eigen::Index kReadingErrors = kSkews + Eigen::Index{kJoints} * kReadingShapes;

/// Where the readings of a joint are [rad].
struct JointRange {
  double middle = 0.0;
  double half = 0.0;  ///< to either end

  /// Whether an error once a turn shows as one.
  bool turns() const;
  /// Errors of 1 rad at a reading: its sine and cosine, or where it does not turn that far what
  /// grows over the range, and its square.
  Eigen::Vector2d shapes(double reading) const;
};
using JointRanges = std::array<JointRange, kJoints>;

JointRanges rangesOf(const std::vector<MotionSpan>& spans);

/// Derivatives of a window's residuals by each error of the readings [per s, per rad].
class ReadingErrorEvaluator {
 public:
  /// Keeps references.
  ReadingErrorEvaluator(const MotionOptions& options, const JointRanges& ranges)
      // By one radian of a reading.
      : balance_(options, Eigen::Vector3d::Ones()), ranges_(ranges) {}

  Eigen::MatrixXd evaluate(const MotionSpan& span,
                           const MotionWindow& window,
                           const MotionPoint& point);

 private:
  BalanceEvaluator balance_;
  const JointRanges& ranges_;
  WindowBalance values_;
};

}  // namespace sac
