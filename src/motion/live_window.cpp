#include "live_window.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spherical_actuator_calibration/base/parallel_for.hpp"

namespace sac {

LiveWindow::LiveWindow(MotionSlice slice)
    : streams_(std::make_unique<const MotionStreams>(std::move(slice.streams))),
      span_(*streams_),
      duration_(span_.track.time(slice.window.last) - span_.track.time(slice.window.first)) {
  term.window = {0, slice.window.first, slice.window.last};
}

void LiveWindow::linearize(const MotionPoint& point,
                           const BalanceOrder& order,
                           BalanceEvaluator& evaluator) {
  evaluator.evaluate(span_, term.window, point, order, term.balance);
  linearized_at_ = point.x();
}

void LiveWindow::linearize(const MotionPoint& point,
                           const BalanceOrder& order,
                           std::vector<BalanceEvaluator>& evaluators,
                           const std::function<void()>& beside) {
  evaluate(point, order, evaluators, beside, term.balance);
  linearized_at_ = point.x();
}

void LiveWindow::evaluate(const MotionPoint& point,
                          const BalanceOrder& order,
                          std::vector<BalanceEvaluator>& evaluators,
                          const std::function<void()>& beside,
                          WindowBalance& out) const {
  // More would rather wait for each other.
  constexpr std::size_t kMostParts = 4;
  const std::size_t parts = std::min(evaluators.size(), kMostParts);
  parallelFor(parts + 1, static_cast<unsigned>(parts), [&](unsigned, std::size_t n) {
    if (n < parts) {
      evaluators[n].sumUp(span_, term.window, point, order, {n, parts});
    } else {
      beside();
    }
  });
  for (std::size_t n = 1; n < parts; ++n) {
    evaluators.front().add(evaluators[n]);
  }
  evaluators.front().conclude(point, out);
}

void LiveWindow::linearizeOrientations(const CalibrationModel& model,
                                       const MotionPlaces& places,
                                       const std::vector<Eigen::Index>& orienting,
                                       const Eigen::VectorXd& x,
                                       double stddev) {
  orientation = InformationSum(static_cast<Eigen::Index>(orienting.size()));
  orientations = 0;
  orientation_residual_.setZero();
  orientation_jacobian_.setZero(3, orientation.gradient().size());
  orientation_at_ = x(orienting);
  // All at once, which is faster than one by one.
  const auto most = static_cast<Eigen::Index>(3 * span_.orientation_times.size());
  Eigen::MatrixXd jacobian(most, orientation.gradient().size());
  Eigen::VectorXd residual(most);
  Eigen::Index rows = 0;
  TrackerTerm tracker(model, places, x);
  for (std::size_t n = 0; n < span_.orientation_times.size(); ++n) {
    if (!tracker.evaluate(span_, n)) {
      continue;
    }
    const Eigen::Vector3d whitened = tracker.residual() / stddev;
    const double weight = robustWeight(whitened.squaredNorm() / 3.0);
    const double root = std::sqrt(weight);
    residual.segment<3>(rows) = root * whitened;
    for (std::size_t k = 0; k < orienting.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const Eigen::Vector3d derivative = tracker.jacobian().col(orienting[k]) / stddev;
      jacobian.block<3, 1>(rows, column) = root * derivative;
      orientation_jacobian_.col(column) += weight * derivative;
    }
    orientation_residual_ += weight * whitened;
    rows += 3;
    ++orientations;
  }
  orientation.addDense(jacobian.topRows(rows), residual.head(rows));
}

void LiveWindow::addMeanTo(InformationSum& sum, const Eigen::VectorXd& x, double weight) const {
  if (orientations == 0) {
    return;
  }
  const Eigen::Vector3d residual =
      orientation_residual_ + orientation_jacobian_ * (x - orientation_at_);
  sum.addDense(orientation_jacobian_, residual, weight / static_cast<double>(orientations));
}

void LiveWindow::whiten(double joint_factor, double current_variance) {
  term.whitening = whiteningOfMany(joint_factor * term.balance.by_joints +
                                   current_variance * term.balance.by_currents);
}

}  // namespace sac
