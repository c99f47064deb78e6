#include "saturated_readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

/// Looks at one column of readings twice, times a sign: where it ends, and how it gets there.
class EndSearch {
 public:
  void see(double value) {
    largest_ = std::max(largest_, value);
    smallest_ = std::min(smallest_, value);
  }

  /// The second time. `goes_on`: it is seen that what is measured moves.
  void count(double value, bool goes_on) {
    const bool is_at_end = value == largest_;
    if (!is_at_end && value >= next_) {
      at_next_ = value > next_ ? 1 : at_next_ + 1;
      next_ = value;
    }
    if (is_at_end && goes_on) {
      ++at_end_;
      runs_ += ++run_ == kLongRun ? 1 : 0;
    }
    if (!is_at_end) {
      run_ = 0;
    }
  }
  void interrupt() { run_ = 0; }

  bool isSaturated() const {
    constexpr std::size_t kAgain = 3;  // times
    // The turns of a motion that is told in coarse steps have about as many readings at the next.
    constexpr std::size_t kCrowd = 4;
    // Of the range: of a few levels alone nothing is told.
    constexpr double kNear = 0.05;
    return runs_ >= kAgain && at_end_ >= kCrowd * at_next_ &&
           largest_ - next_ < kNear * (largest_ - smallest_);
  }
  double value() const { return largest_; }

 private:
  static constexpr std::size_t kLongRun = 3;

  double largest_ = -std::numeric_limits<double>::infinity();
  double smallest_ = std::numeric_limits<double>::infinity();
  double next_ = -std::numeric_limits<double>::infinity();  ///< largest that is not at the end
  std::size_t at_end_ = 0;
  std::size_t at_next_ = 0;
  std::size_t run_ = 0;
  std::size_t runs_ = 0;  ///< of at least so many at the end
};

/// Ends of `columns` readings that are reached. `rows`: of a span; `row`: calls its visitor with
/// column, value, and whether it is seen that what is measured moves.
template <typename Rows, typename Row>
std::vector<RangeEnd> endsOf(const std::vector<MotionSpan>& spans,
                             std::size_t columns,
                             const Rows& rows,
                             const Row& row) {
  std::vector<EndSearch> upper(columns);
  std::vector<EndSearch> lower(columns);
  for (const MotionSpan& span : spans) {
    for (std::size_t n = 0; n < rows(span); ++n) {
      row(span, n, [&](std::size_t column, double value, bool /*goes_on*/) {
        upper[column].see(value);
        lower[column].see(-value);
      });
    }
  }
  for (const MotionSpan& span : spans) {
    for (std::size_t column = 0; column < columns; ++column) {
      upper[column].interrupt();
      lower[column].interrupt();
    }
    for (std::size_t n = 0; n < rows(span); ++n) {
      row(span, n, [&](std::size_t column, double value, bool goes_on) {
        upper[column].count(value, goes_on);
        lower[column].count(-value, goes_on);
      });
    }
  }
  std::vector<RangeEnd> ends;
  for (std::size_t column = 0; column < columns; ++column) {
    if (upper[column].isSaturated()) {
      ends.push_back({column, upper[column].value()});
    }
    if (lower[column].isSaturated()) {
      ends.push_back({column, -lower[column].value()});
    }
  }
  return ends;
}

std::vector<RangeEnd> endsOfCoils(const std::vector<MotionSpan>& spans) {
  return endsOf(
      spans,
      static_cast<std::size_t>(spans.front().streams->currents.cols()),
      [](const MotionSpan& span) {
        return static_cast<std::size_t>(span.streams->currents.rows());
      },
      [](const MotionSpan& span, std::size_t n, const auto& visit) {
        const auto row = span.streams->currents.row(static_cast<Eigen::Index>(n));
        for (Eigen::Index j = 0; j < row.size(); ++j) {
          visit(static_cast<std::size_t>(j), static_cast<double>(row[j]), true);
        }
      });
}

/// A rotor at rest, too, has readings that are alike: at the end of a range the others go on.
std::vector<RangeEnd> endsOfJoints(const std::vector<MotionSpan>& spans) {
  constexpr std::size_t kAngles = 3;
  return endsOf(
      spans,
      kAngles,
      [](const MotionSpan& span) { return span.track.size(); },
      [](const MotionSpan& span, std::size_t n, const auto& visit) {
        const Eigen::Vector3d& now = span.track.reading(n);
        const Eigen::Vector3d& before = span.track.reading(n == 0 ? 0 : n - 1);
        for (Eigen::Index k = 0; k < 3; ++k) {
          const Eigen::Index one = (k + 1) % 3;
          const Eigen::Index other = (k + 2) % 3;
          const bool goes_on = now[one] != before[one] && now[other] != before[other];
          visit(static_cast<std::size_t>(k), now[k], goes_on);
        }
      });
}

}  // namespace

SaturatedReadings::SaturatedReadings(const std::vector<MotionSpan>& spans) : spans_(spans) {
  if (!spans.empty()) {
    of_coils_ = endsOfCoils(spans);
    of_joints_ = endsOfJoints(spans);
  }
}

std::string SaturatedReadings::within(const MotionWindow& window, double largest_delay) const {
  const MotionSpan& span = spans_[window.span];
  for (const RangeEnd& end : of_joints_) {
    for (std::size_t n = window.first; n <= window.last; ++n) {
      if (span.track.reading(n)[static_cast<Eigen::Index>(end.column)] == end.value) {
        return format(
            "joint %zu reads no further than %.4g rad, as at the end of its sensor's range",
            numberOf(end.column),
            end.value);
      }
    }
  }
  const StampTimes& times = span.current_times;
  const std::size_t begin = times.firstFrom(span.track.time(window.first) - largest_delay);
  const std::size_t last = times.firstFrom(span.track.time(window.last) + largest_delay);
  for (const RangeEnd& end : of_coils_) {
    for (std::size_t n = begin; n < last; ++n) {
      if (static_cast<double>(span.streams->currents(
              static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(end.column))) == end.value) {
        return format(
            "the current of coil %zu reads no further than %.4g A, as at the end of its sensor's "
            "range",
            numberOf(end.column),
            end.value);
      }
    }
  }
  return {};
}

}  // namespace sac
