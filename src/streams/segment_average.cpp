#include "segment_average.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "quantization.hpp"
#include "robust_mean.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

/// A difference of means counts as motion beyond the limit plus this many of its standard
/// deviations: three pairs of thirds are looked at in three components.
constexpr double kDriftSignificance = 4.0;
/// Of a single orientation, over the largest motion: beyond it the tracker is disturbed.
constexpr double kLargestNoise = 10.0;

constexpr double kMilli = 1e3;

std::size_t smallestCount(const SampleBuilderOptions& options) {
  return static_cast<std::size_t>(options.smallest_count);
}

Eigen::Quaterniond quaternionAt(const StreamBuffer& orientations, std::size_t index) {
  return Eigen::Quaterniond(Eigen::Vector4d(orientations.values(index)));
}

/// Rotation vector [rad] of a unit quaternion.
Eigen::Vector3d rotationVector(const Eigen::Quaterniond& q) {
  const double norm = q.vec().norm();
  if (norm == 0.0) {
    return Eigen::Vector3d::Zero();
  }
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  return sign * 2.0 * std::atan2(norm, sign * q.w()) / norm * q.vec();
}

/// An orientation that is not a glitch itself: of three, the one nearest to the other two.
Eigen::Quaterniond referenceOrientation(const StreamBuffer& orientations,
                                        const StreamBuffer::Range& range) {
  const std::array<Eigen::Quaterniond, 3> candidates = {
      quaternionAt(orientations, range.first + range.size() / 4),
      quaternionAt(orientations, range.first + range.size() / 2),
      quaternionAt(orientations, range.first + range.size() * 3 / 4)};
  std::size_t best = 0;
  double best_agreement = -1.0;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const double agreement = std::abs(candidates[k].dot(candidates[(k + 1) % 3])) +
                             std::abs(candidates[k].dot(candidates[(k + 2) % 3]));
    if (agreement > best_agreement) {
      best = k;
      best_agreement = agreement;
    }
  }
  return candidates[best];
}

/// Longest time without a measurement in the interval [s], its ends included.
double longestHole(const StreamBuffer& buffer,
                   const StreamBuffer::Range& range,
                   const StampInterval& interval) {
  Stamp previous = interval.begin;
  Stamp longest = 0;
  for (std::size_t index = range.first; index < range.last; ++index) {
    longest = std::max(longest, buffer.stamp(index) - previous);
    previous = buffer.stamp(index);
  }
  return secondsBetween(0, std::max(longest, interval.end - previous));
}

/// Makes one sample, quantity by quantity; the first refusal stays.
class SegmentAverager {
 public:
  SegmentAverager(const MeasurementBuffers& buffers,
                  const StampInterval& interval,
                  const SampleBuilderOptions& options)
      : buffers_(buffers), interval_(interval), options_(options) {}

  SegmentAverage average() {
    if (interval_.duration() < options_.smallest_duration) {
      return refused("It lasts only " + shortNumber(std::max(interval_.duration(), 0.0)) + " s; " +
                     shortNumber(options_.smallest_duration) + " s are needed.");
    }
    if ((buffers_.has_joints && !averageJoints()) || !averageOrientation()) {
      return std::move(result_);
    }
    if (!buffers_.has_joints && !sample_.has_orientation) {
      return refused("It has no orientation, which alone tells where the rotor is.");
    }
    averageTorque();
    if (!sample_.has_orientation && !sample_.has_torque) {
      return refused("It has neither orientation nor torque.");
    }
    sample_.stamp = interval_.middle();
    sample_.duration = interval_.duration();
    sample_.measurements = static_cast<std::uint32_t>(fewest_);
    result_.sample = sample_;
    return std::move(result_);
  }

 private:
  SegmentAverage refused(std::string reason) {
    refuse(std::move(reason));
    return std::move(result_);
  }

  bool refuse(std::string reason) {
    result_.refusal = std::move(reason);
    return false;
  }

  void count(std::size_t measurements) { fewest_ = std::min(fewest_, measurements); }

  bool averageJoints() {
    const StreamBuffer::Range range = buffers_.joints.within(interval_);
    RobustMean mean({options_.outlier_factor, options_.joint_stddev_floor});
    mean.reserve(range.size());
    for (std::size_t index = range.first; index < range.last; ++index) {
      mean.add(buffers_.joints.values(index));
    }
    if (mean.count() < smallestCount(options_)) {
      return refuse("It has only " + std::to_string(mean.count()) + " joint measurements.");
    }
    const MeanEstimate estimate = mean.estimate();
    result_.joint_glitches = estimate.glitches;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (estimate.drift[k] >
          options_.largest_joint_drift + kDriftSignificance * estimate.drift_stddev[k]) {
        return refuse("joint_" + std::to_string(numberOf(static_cast<std::size_t>(k))) +
                      " drifted by " + shortNumber(estimate.drift[k] * kMilli) + " mrad.");
      }
      // A range is at least twice the standard deviation.
      const double stddev = std::sqrt(estimate.single_variance[k]);
      if (2.0 * stddev > options_.largest_joint_spread) {
        return refuse("joint_" + std::to_string(numberOf(static_cast<std::size_t>(k))) +
                      " was not at rest: its readings scatter by " + shortNumber(stddev * kMilli) +
                      " mrad.");
      }
    }
    sample_.joint_position = estimate.mean;
    Eigen::Vector3d of_steps;
    for (Eigen::Index k = 0; k < 3; ++k) {
      of_steps[k] = quantizationVariance(buffers_.joint_step[k], estimate.single_variance[k]);
    }
    const double floor = options_.joint_stddev_floor;
    sample_.joint_stddev = (estimate.variance + of_steps).array() + floor * floor;
    sample_.joint_stddev = sample_.joint_stddev.cwiseSqrt();
    sample_.joint_shared_stddev = of_steps.cwiseSqrt();
    count(estimate.count);
    return true;
  }

  /// False when the orientation contradicts the rest that the joints tell of.
  bool averageOrientation() {
    const StreamBuffer::Range range = buffers_.orientations.within(interval_);
    if (!isEnough("orientation", buffers_.orientations, range)) {
      return true;
    }
    // Left rotation vectors from a reference near the mean: their mean is the rotation mean up to
    // third order in the scatter.
    const Eigen::Quaterniond q_stator_reference =
        referenceOrientation(buffers_.orientations, range);
    RobustMean mean({options_.outlier_factor, options_.orientation_stddev_floor});
    mean.reserve(range.size());
    for (std::size_t index = range.first; index < range.last; ++index) {
      mean.add(rotationVector(quaternionAt(buffers_.orientations, index) *
                              q_stator_reference.conjugate()));
    }
    const MeanEstimate estimate = mean.estimate();
    result_.orientation_glitches = estimate.glitches;
    const char* const otherwise =
        buffers_.has_joints ? " mrad while the joint sensors stood still." : " mrad.";
    const double drift = estimate.drift.norm();
    const double largest_drift =
        buffers_.has_joints ? options_.largest_orientation_motion : options_.largest_joint_drift;
    if (drift > largest_drift + kDriftSignificance * estimate.drift_stddev.norm()) {
      return refuse("The measured orientation moved by " + shortNumber(drift * kMilli) + otherwise);
    }
    const double sway = std::sqrt(estimate.slow_variance.maxCoeff());
    if (sway > options_.largest_orientation_motion) {
      return refuse("The measured orientation sways by " + shortNumber(sway * kMilli) +
                    " mrad while the joint sensors stood still.");
    }
    // Noise of single measurements is none of motion: the mean states how well it is known.
    const double stddev = std::sqrt(estimate.single_variance.maxCoeff());
    if (stddev > kLargestNoise * options_.largest_orientation_motion) {
      return refuse("The measured orientation scatters by " + shortNumber(stddev * kMilli) +
                    otherwise);
    }
    sample_.has_orientation = true;
    sample_.R_stator_rotor = rotationExp(estimate.mean) * q_stator_reference.toRotationMatrix();
    sample_.orientation_stddev =
        std::hypot(std::sqrt(estimate.variance.mean()), options_.orientation_stddev_floor);
    if (!buffers_.has_joints) {
      sample_ = trackedSample(sample_, options_.orientation_stddev_floor);
    }
    count(estimate.count);
    return true;
  }

  void averageTorque() {
    const StreamBuffer::Range range = buffers_.torques.within(interval_);
    if (!isEnough("torque", buffers_.torques, range)) {
      return;
    }
    RobustMean mean({options_.outlier_factor, options_.torque_stddev_floor});
    mean.reserve(range.size());
    for (std::size_t index = range.first; index < range.last; ++index) {
      mean.add(buffers_.torques.values(index));
    }
    const MeanEstimate estimate = mean.estimate();
    result_.torque_glitches = estimate.glitches;
    result_.torque_count = estimate.count;
    sample_.has_torque = true;
    sample_.torque = estimate.mean;
    sample_.torque_stddev =
        std::hypot(std::sqrt(estimate.variance.mean()), options_.torque_stddev_floor);
    count(estimate.count);
  }

  /// Tells of missing measurements, unless the stream is not there at all.
  bool isEnough(const std::string& quantity,
                const StreamBuffer& buffer,
                const StreamBuffer::Range& range) {
    if (range.size() < smallestCount(options_)) {
      if (!buffer.empty()) {
        result_.notes.push_back("It has no " + quantity + ": only " + std::to_string(range.size()) +
                                " measurements of it.");
      }
      return false;
    }
    const double hole = longestHole(buffer, range, interval_);
    if (hole > options_.largest_gap) {
      result_.notes.push_back("The measured " + quantity + " has a hole of " + shortNumber(hole) +
                              " s; the rest of it is averaged.");
    }
    return true;
  }

  const MeasurementBuffers& buffers_;
  StampInterval interval_;
  const SampleBuilderOptions& options_;
  Sample sample_;
  std::size_t fewest_ = std::numeric_limits<std::size_t>::max();
  SegmentAverage result_;
};

}  // namespace

SegmentAverage averageSegment(const MeasurementBuffers& buffers,
                              const StampInterval& interval,
                              const SampleBuilderOptions& options) {
  return SegmentAverager(buffers, interval, options).average();
}

}  // namespace sac
