#include "reading_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spherical_actuator_calibration/base/rotations.hpp"

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

bool JointRange::turns() const {
  constexpr double kLeastTurn = 2.0;  // [rad] to either side
  return half > kLeastTurn;
}

Eigen::Vector2d JointRange::shapes(double reading) const {
  if (turns()) {
    return {std::sin(reading), std::cos(reading)};
  }
  const double share = half > 0.0 ? (reading - middle) / half : 0.0;
  return {share, share * share};
}

JointRanges rangesOf(const std::vector<MotionSpan>& spans) {
  JointRanges ranges;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const auto joint = static_cast<Eigen::Index>(k);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const MotionSpan& span : spans) {
      for (std::size_t n = 0; n < span.track.size(); ++n) {
        least = std::min(least, span.track.reading(n)[joint]);
        most = std::max(most, span.track.reading(n)[joint]);
      }
    }
    if (least <= most) {
      ranges[k] = {0.5 * (least + most), 0.5 * (most - least)};
    }
  }
  return ranges;
}

Eigen::MatrixXd ReadingErrorEvaluator::evaluate(const MotionSpan& span,
                                                const MotionWindow& window,
                                                const MotionPoint& point) {
  BalanceOrder order;
  order.covariance = true;
  balance_.evaluate(span, window, point, order, values_);
  const Eigen::MatrixXd& by_readings = balance_.byReadings();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(by_readings.rows(), kReadingErrors);
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
    const Eigen::Vector3d& angles = span.track.reading(reading);
    for (Eigen::Index k = 0; k < Eigen::Index{kJoints}; ++k) {
      const Eigen::Vector2d shapes = ranges_[static_cast<std::size_t>(k)].shapes(angles[k]);
      result.middleCols<kReadingShapes>(kSkews + kReadingShapes * k) -=
          by_readings.col(3 * n + k) * shapes.transpose();
    }
  }
  return result;
}

}  // namespace sac
