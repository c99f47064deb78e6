#include "current_segments.hpp"

#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"

namespace sac {
namespace {

/// Grows one span of constant current, measurement by measurement.
class GrowingSegment {
 public:
  GrowingSegment(const StreamBuffer& currents, std::size_t first, double tolerance)
      : currents_(currents),
        largest_spread_(2.0 * tolerance),
        begin_(currents.stamp(first)),
        end_(begin_),
        smallest_(currents.values(first)),
        largest_(smallest_),
        sum_(smallest_) {}

  bool fits(std::size_t index) const {
    const auto row = currents_.values(index).array();
    return (largest_.max(row) - smallest_.min(row)).maxCoeff() <= largest_spread_;
  }

  void add(std::size_t index) {
    const auto row = currents_.values(index).array();
    smallest_ = smallest_.min(row);
    largest_ = largest_.max(row);
    sum_ += row;
    ++count_;
    end_ = currents_.stamp(index);
  }

  CurrentSegment result(double threshold) const {
    CurrentSegment segment;
    segment.span = {begin_, end_};
    segment.current = sum_ / static_cast<double>(count_);
    segment.excited = isExcited(segment.current.cwiseAbs().maxCoeff(), threshold);
    return segment;
  }

 private:
  const StreamBuffer& currents_;
  double largest_spread_;
  Stamp begin_;
  Stamp end_;
  Eigen::ArrayXd smallest_;
  Eigen::ArrayXd largest_;
  Eigen::ArrayXd sum_;
  std::size_t count_ = 1;
};

}  // namespace

std::vector<CurrentSegment> segmentsOfConstantCurrent(const StreamBuffer& currents,
                                                      const StampInterval& dwell,
                                                      const SampleBuilderOptions& options) {
  const StreamBuffer::Range range = currents.within(dwell);
  const Stamp largest_gap = ticksFromSeconds(options.largest_gap);
  std::vector<CurrentSegment> segments;
  std::size_t index = range.first;
  while (index < range.last) {
    GrowingSegment segment(currents, index, options.current_tolerance);
    Stamp previous = currents.stamp(index);
    for (++index; index < range.last; ++index) {
      if (currents.stamp(index) - previous > largest_gap) {
        break;
      }
      previous = currents.stamp(index);
      if (segment.fits(index)) {
        segment.add(index);
        continue;
      }
      const bool is_glitch = index + 1 < range.last && segment.fits(index + 1);
      if (!is_glitch) {
        break;
      }
    }
    segments.push_back(segment.result(options.current_threshold));
  }
  return segments;
}

MeanCurrent meanCurrent(const StreamBuffer& currents,
                        const StampInterval& interval,
                        const CurrentSegment& segment,
                        const SampleBuilderOptions& options) {
  const double limit = 2.0 * options.current_tolerance;
  const StreamBuffer::Range range = currents.within(interval);
  MeanCurrent mean;
  mean.current = Eigen::VectorXd::Zero(segment.current.size());
  for (std::size_t index = range.first; index < range.last; ++index) {
    const auto row = currents.values(index);
    if ((row - segment.current).cwiseAbs().maxCoeff() <= limit) {
      mean.current += row;
      ++mean.count;
    }
  }
  if (mean.count > 0) {
    mean.current /= static_cast<double>(mean.count);
  }
  return mean;
}

}  // namespace sac
