#include "motion_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "tracker_term.hpp"

namespace sac {
namespace {

/// Differences are sampled where there are more.
constexpr std::size_t kEnough = 20000;

/// Standard deviation of what has this one's absolute values, by their median.
double robustStddev(std::vector<double> magnitudes) {
  if (magnitudes.empty()) {
    return 0.0;
  }
  return medianOf(std::move(magnitudes)) / kMedianOfNormal;
}

/// Standard deviation of white noise by third differences of series, each `get(n)` for n < count.
class ThirdDifferences {
 public:
  template <typename Get>
  void add(std::size_t count, const Get& get) {
    const std::size_t stride = std::max<std::size_t>(1, count / kEnough);
    for (std::size_t n = 3; n < count; n += stride) {
      magnitudes_.push_back(std::abs(get(n) - 3.0 * get(n - 1) + 3.0 * get(n - 2) - get(n - 3)));
    }
  }
  double stddev() const { return robustStddev(magnitudes_) / std::sqrt(20.0); }

  /// Standard deviation of the variance, over its value, where noise is white.
  double chance() const {
    constexpr double kOfMedian = 5.44;  // of as many normal values, times their number, squared
    constexpr double kOverlap = 2.3;    // neighbouring differences have readings in common
    const auto count = static_cast<double>(std::max<std::size_t>(1, magnitudes_.size()));
    return std::sqrt(kOfMedian * kOverlap / count);
  }

 private:
  std::vector<double> magnitudes_;
};

}  // namespace

double trackerNoise(const std::vector<MotionSpan>& spans,
                    const CalibrationModel& model,
                    const Eigen::VectorXd& x,
                    std::size_t most) {
  // A stream without noise has at least that of its numbers.
  constexpr double kLeast = 1e-8;
  // A marker seen from one side is turned well about some axes, and badly about another.
  std::array<ThirdDifferences, 3> differences;
  const MotionPlaces places(model.space());
  for (const MotionSpan& span : spans) {
    TrackerTerm term(model, places, x);
    std::vector<Eigen::Vector3d> misfits;
    for (std::size_t n = 0; n < std::min(most, span.orientation_times.size()); ++n) {
      if (term.evaluate(span, n)) {
        misfits.push_back(term.residual());
      }
    }
    for (std::size_t k = 0; k < differences.size(); ++k) {
      differences[k].add(misfits.size(),
                         [&](std::size_t n) { return misfits[n][static_cast<Eigen::Index>(k)]; });
    }
  }
  double squares = 0.0;
  for (const ThirdDifferences& axis : differences) {
    squares += std::pow(axis.stddev(), 2);
  }
  return std::max(kLeast, std::sqrt(squares / 3.0));
}

double meansOverDifferences(const MotionNoise& noise, const std::vector<MotionSpan>& spans) {
  double orientations = 0.0;
  double readings = 0.0;
  for (const MotionSpan& span : spans) {
    orientations += static_cast<double>(span.orientation_times.size());
    readings += static_cast<double>(span.track.size());
  }
  const double shared = noise.joint.squaredNorm() / 3.0 * orientations / std::max(1.0, readings);
  return 1.0 + shared / (noise.orientation * noise.orientation);
}

MotionNoise noiseOf(const std::vector<MotionSpan>& spans,
                    const CalibrationModel& model,
                    const Eigen::VectorXd& x) {
  // Streams without noise have at least that of their numbers.
  constexpr double kLeastJoint = 1e-9;
  constexpr double kLeastCurrent = 1e-7;
  MotionNoise noise;
  for (Eigen::Index k = 0; k < 3; ++k) {
    ThirdDifferences joint;
    for (const MotionSpan& span : spans) {
      joint.add(span.track.size(), [&](std::size_t n) { return span.track.reading(n)[k]; });
    }
    noise.joint[k] = std::max(kLeastJoint, joint.stddev());
    noise.chance.joints = joint.chance();
  }
  ThirdDifferences current;
  for (const MotionSpan& span : spans) {
    for (Eigen::Index j = 0; j < span.streams->currents.cols(); ++j) {
      current.add(span.current_times.size(), [&](std::size_t n) {
        return static_cast<double>(span.streams->currents(static_cast<Eigen::Index>(n), j));
      });
    }
  }
  noise.current = std::max(kLeastCurrent, current.stddev());
  noise.chance.currents = current.chance();
  noise.orientation = trackerNoise(spans, model, x, kEnough);
  return noise;
}

}  // namespace sac
