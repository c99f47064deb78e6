#include "joint_skew.hpp"

#include <algorithm>

namespace sac {

namespace {

/// Rates of the joints at a reading [rad/s].
Eigen::Vector3d jointRates(const JointTrack& track, std::size_t reading) {
  const std::size_t reach = std::max<std::size_t>(1, track.rateReach());
  const std::size_t from = reading - std::min(reading, reach);
  const std::size_t to = std::min(track.size() - 1, reading + reach);
  return (track.reading(to) - track.reading(from)) / (track.time(to) - track.time(from));
}

}  // namespace

Eigen::MatrixXd SkewEvaluator::evaluate(const MotionSpan& span,
                                        const MotionWindow& window,
                                        const MotionPoint& point) {
  BalanceOrder order;
  order.covariance = true;
  balance_.evaluate(span, window, point, order, values_);
  const Eigen::MatrixXd& by_readings = balance_.byReadings();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(by_readings.rows(), kSkews);
  for (Eigen::Index n = 0; 3 * n < by_readings.cols(); ++n) {
    const std::size_t reading = window.first - kBeside + static_cast<std::size_t>(n);
    if (reading >= span.track.size()) {
      continue;
    }
    // What is read later shows where the joint is by then.
    const Eigen::Vector3d rates = jointRates(span.track, reading);
    for (Eigen::Index k = 0; k < kSkews; ++k) {
      result.col(k) -= rates[k + 1] * by_readings.col(3 * n + k + 1);
    }
  }
  return result;
}

}  // namespace sac
