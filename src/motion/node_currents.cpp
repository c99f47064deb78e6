#include "node_currents.hpp"

#include <algorithm>

namespace sac {

std::size_t nodeStride(const MotionSpan& span) {
  constexpr double kApart = 2.05e-3;  // [s]
  return std::max<std::size_t>(1, static_cast<std::size_t>(kApart / span.current_step));
}

void NodeCurrents::gather(std::size_t row, std::size_t first, std::size_t last) {
  const StampTimes& times = span_->current_times;
  const auto& currents = span_->streams->currents;
  const std::size_t reach = 3 * every_ - 1;
  const auto at = [&](std::size_t n) {
    return currents.row(static_cast<Eigen::Index>(n)).transpose().cast<double>();
  };
  step_ = 0.0;
  current_.setZero(currents.cols());
  bend_.setZero(currents.cols());
  for (std::size_t n = std::max(first, row - std::min(row, reach));
       n < std::min(last, row + reach + 1);
       ++n) {
    const double share = shareOf(n, row);
    if (share == 0.0) {
      continue;
    }
    const double before = times[n] - times[n - 1];
    const double after = times[n + 1] - times[n];
    const double step = 0.5 * (before + after) * share;
    step_ += step;
    current_ += step * at(n);
    bend_ += (share / after) * (at(n + 1) - at(n)) - (share / before) * (at(n) - at(n - 1));
  }
  current_ /= step_;
  bend_ /= step_;
}

/// Of Lagrange's polynomial through the six nodes around a reading; near the ends of a stream,
/// where the test functions are next to nothing, through two.
double NodeCurrents::shareOf(std::size_t reading, std::size_t node) const {
  const StampTimes& times = span_->current_times;
  const std::size_t below = reading - reading % every_;
  if (reading == below) {
    return reading == node ? 1.0 : 0.0;
  }
  const bool is_inside = below >= 2 * every_ && below + 3 * every_ < times.size();
  const std::size_t begin = is_inside ? below - 2 * every_ : below;
  const std::size_t end = std::min(times.size(), below + (is_inside ? 4 : 2) * every_);
  if (node < begin || node >= end) {
    return 0.0;
  }
  double share = 1.0;
  for (std::size_t other = begin; other < end; other += every_) {
    if (other != node) {
      share *= (times[reading] - times[other]) / (times[node] - times[other]);
    }
  }
  return share;
}

}  // namespace sac
