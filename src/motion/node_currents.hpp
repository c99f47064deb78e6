#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "current_readings.hpp"
#include "motion_span.hpp"

namespace sac {

/// Currents of many readings as those of few, the nodes: every so manieth of them. Between nodes
/// the torque of an ampere, times a test function, is a polynomial of time of fifth degree, near
/// enough; so what a reading counts for goes to the six nodes around it, and only there the torque
/// is asked for.
class NodeCurrents {
 public:
  /// Keeps a reference. `every`: of so many readings one is a node, at least 2.
  NodeCurrents(const MotionSpan& span, std::size_t every) : span_(&span), every_(every) {}

  /// Gathers what readings in [first, last) count for at the node `row`, a multiple of `every`.
  void gather(std::size_t row, std::size_t first, std::size_t last);

  /// From the node before one to the one after it, and a reading more [s].
  double reach() const { return (2.0 * static_cast<double>(every_) + 1.0) * span_->current_step; }
  double step() const { return step_; }                        ///< what they count for [s]
  const Eigen::VectorXd& current() const { return current_; }  ///< their mean [A]
  const Eigen::VectorXd& bend() const { return bend_; }  ///< of their second derivatives [A/s²]

 private:
  double shareOf(std::size_t reading, std::size_t node) const;

  const MotionSpan* span_;
  std::size_t every_;
  double step_ = 0.0;
  Eigen::VectorXd current_;
  Eigen::VectorXd bend_;
};

/// Of so many readings of the currents of a span one may be a node: two milliseconds apart at most.
std::size_t nodeStride(const MotionSpan& span);

}  // namespace sac
