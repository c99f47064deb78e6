#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/motion/motion_slice.hpp"

namespace sac {

/// A window that is kept, with what it tells where it was linearised last.
class LiveWindow {
 public:
  explicit LiveWindow(MotionSlice slice);

  const MotionSpan& span() const { return span_; }
  const MotionStreams& streams() const { return *streams_; }
  WindowRange range() const { return {term.window.first, term.window.last}; }
  double duration() const { return duration_; }

  /// Linearises its balance at a point; its whitening as well where the order says so.
  void linearize(const MotionPoint& point, const BalanceOrder& order, BalanceEvaluator& evaluator);
  /// The same by several, each in a thread of its own: in less time. `beside` is done by the thread
  /// that ends first.
  void linearize(const MotionPoint& point,
                 const BalanceOrder& order,
                 std::vector<BalanceEvaluator>& evaluators,
                 const std::function<void()>& beside);
  /// Its balance at a point, by several.
  void evaluate(const MotionPoint& point,
                const BalanceOrder& order,
                std::vector<BalanceEvaluator>& evaluators,
                const std::function<void()>& beside,
                WindowBalance& out) const;
  /// Linearises its orientations at x, and sums them up in the coordinates that they tell of.
  /// `stddev`: of the tracker, per component [rad].
  void linearizeOrientations(const CalibrationModel& model,
                             const MotionPlaces& places,
                             const std::vector<Eigen::Index>& orienting,
                             const Eigen::VectorXd& x,
                             double stddev);
  void whiten(double joint_factor, double current_variance);

  /// Residual at coordinates x, as the derivatives say.
  Eigen::VectorXd balanceAt(const Eigen::VectorXd& x) const {
    return term.balance.residual + term.balance.jacobian * (x - linearized_at_);
  }
  /// Whitened.
  Eigen::VectorXd residualAt(const Eigen::VectorXd& x) const { return whitened(balanceAt(x)); }
  Eigen::VectorXd whitened(const Eigen::VectorXd& residual) const {
    return term.whitening.triangularView<Eigen::Lower>() * residual;
  }
  Eigen::MatrixXd whitenedJacobian() const {
    return term.whitening.triangularView<Eigen::Lower>() * term.balance.jacobian;
  }
  const Eigen::VectorXd& linearizedAt() const { return linearized_at_; }
  /// Adds the sum of whitened orientation residuals at x, over the root of their number, whose
  /// square is three on average where their noise is white. `x`: of the coordinates that
  /// orientations tell of.
  void addMeanTo(InformationSum& sum, const Eigen::VectorXd& x, double weight) const;

  WindowTerm term;
  InformationSum orientation{0};  ///< at the place of linearisation
  std::size_t orientations = 0;   ///< that serve

 private:
  std::unique_ptr<const MotionStreams> streams_;  ///< does not move with the window
  MotionSpan span_;
  double duration_;  ///< [s]
  Eigen::VectorXd linearized_at_;
  // Of whitened orientations, summed up.
  Eigen::Vector3d orientation_residual_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd orientation_jacobian_;
  Eigen::VectorXd orientation_at_;  ///< of the coordinates that they tell of
};

}  // namespace sac
