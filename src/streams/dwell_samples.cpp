#include "dwell_samples.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "current_segments.hpp"
#include "segment_average.hpp"

namespace sac {
namespace {

/// A sample before its bias is removed.
struct Candidate {
  Sample sample;
  bool excited = false;
  std::size_t torque_count = 0;
};

/// What acts without current: mean over all zero-current spans.
struct ZeroCurrentPart {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  double torque_variance = 0.0;
  Eigen::VectorXd current;
  double weight = 0.0;  ///< torque measurements in it; 0: there is no such part
};

/// Samples of one dwell; see samplesOfDwell() and sampleOfSpan().
class DwellSampler {
 public:
  DwellSampler(const MeasurementBuffers& buffers,
               const StampInterval& dwell,
               const SampleBuilderOptions& options,
               SampleBuilderReport& report)
      : buffers_(buffers),
        dwell_(dwell),
        rest_{dwell.begin + ticksFromSeconds(options.settle_after_motion),
              dwell.end - ticksFromSeconds(options.guard_before_motion)},
        options_(options),
        report_(report) {}

  std::vector<Sample> samples() {
    if (rest_.duration() < options_.smallest_duration) {
      discard(dwell_, "The rotor rested only for " + tenths(dwell_.duration()) + " s.");
      return {};
    }
    collectCandidates();
    if (options_.bias_removal == BiasRemoval::kZeroCurrent) {
      removeBias();
    }
    if (!buffers_.has_joints && !shareOrientation()) {
      return {};
    }
    std::vector<Sample> samples;
    for (Candidate& candidate : candidates_) {
      if (candidate.sample.has_orientation || candidate.sample.has_torque) {
        samples.push_back(std::move(candidate.sample));
      }
    }
    report_.samples += samples.size();
    return samples;
  }

  std::vector<StampInterval> stretches() const {
    if (buffers_.currents.within(dwell_).size() == 0) {
      return {rest_};
    }
    std::vector<StampInterval> stretches;
    for (const CurrentSegment& segment :
         segmentsOfConstantCurrent(buffers_.currents, dwell_, options_)) {
      const StampInterval steady = steadyPart(segment);
      if (isWorthwhile(segment, steady)) {
        stretches.push_back(steady);
      }
    }
    return stretches;
  }

  std::optional<Sample> sampleOf(const StampInterval& span) {
    std::optional<std::size_t> wanted;
    if (buffers_.currents.within(dwell_).size() == 0) {
      collectWithoutCurrents(span);
      wanted = 0;
    }
    for (const CurrentSegment& segment :
         segmentsOfConstantCurrent(buffers_.currents, dwell_, options_)) {
      if (holds(segment, span)) {
        wanted = candidates_.size();
        collect(segment, span);
      } else if (!segment.excited && isWorthwhile(segment, steadyPart(segment))) {
        collect(segment, steadyPart(segment));
      }
    }
    if (!wanted) {
      discard(span, "The currents changed.");
    }
    if (!wanted || *wanted >= candidates_.size()) {
      return std::nullopt;
    }
    if (options_.bias_removal == BiasRemoval::kZeroCurrent) {
      removeBias();
    }
    return candidates_[*wanted].sample;
  }

 private:
  static std::string tenths(double seconds) {
    const auto rounded = std::llround(seconds * 10.0);
    return std::to_string(rounded / 10) + "." + std::to_string(rounded % 10);
  }

  void discard(const StampInterval& interval, std::string reason) {
    report_.add({DwellEvent::Kind::kDiscarded, interval.middle(), std::move(reason)});
  }

  void note(const StampInterval& interval, std::string reason) {
    report_.add({DwellEvent::Kind::kNote, interval.middle(), std::move(reason)});
  }

  void collectCandidates() {
    if (buffers_.currents.within(dwell_).size() == 0) {
      collectWithoutCurrents(rest_);
      return;
    }
    bool any_usable = false;
    for (const CurrentSegment& segment :
         segmentsOfConstantCurrent(buffers_.currents, dwell_, options_)) {
      const StampInterval steady = steadyPart(segment);
      if (isWorthwhile(segment, steady)) {
        any_usable = true;
        collect(segment, steady);
      }
    }
    if (!any_usable) {
      discard(dwell_, "No part of it with constant current is long enough.");
    }
  }

  /// Gives all samples of a rotor without joints the orientation of their whole rest: it rested
  /// once, however often the currents changed. False, and an event, where it did not.
  bool shareOrientation() {
    if (candidates_.empty()) {
      return true;
    }
    const std::optional<SegmentAverage> whole = averageOf(rest_);
    for (Candidate& candidate : candidates_) {
      if (whole) {
        candidate.sample.R_stator_rotor = whole->sample->R_stator_rotor;
        candidate.sample.orientation_stddev = whole->sample->orientation_stddev;
        candidate.sample.joint_position = whole->sample->joint_position;
        candidate.sample.joint_stddev = whole->sample->joint_stddev;
        candidate.sample.joint_shared_stddev = whole->sample->joint_stddev;
      }
    }
    return whole.has_value();
  }

  /// The segment without settling and guards.
  StampInterval steadyPart(const CurrentSegment& segment) const {
    return {std::max(rest_.begin,
                     segment.span.begin + ticksFromSeconds(options_.settle_after_current_change)),
            std::min(rest_.end,
                     segment.span.end - ticksFromSeconds(options_.guard_before_current_change))};
  }

  /// Whether all currents of the span belong to the segment. The last one of the dwell may have
  /// been measured shortly before the end of the span.
  bool holds(const CurrentSegment& segment, const StampInterval& span) const {
    const StreamBuffer::Range range = buffers_.currents.within(dwell_);
    const bool is_last = buffers_.currents.stamp(range.last - 1) == segment.span.end;
    return segment.span.begin <= span.begin &&
           (span.end <= segment.span.end ||
            (is_last && secondsBetween(segment.span.end, span.end) <= options_.largest_gap));
  }

  /// Whether the segment is to give a sample, or else a reason. Not the ramps between patterns, and
  /// not a part without current at the ends of the dwell that settling and guard use up.
  bool isWorthwhile(const CurrentSegment& segment, const StampInterval& steady) const {
    const StampInterval& decisive = segment.excited ? segment.span : steady;
    return decisive.duration() >= options_.smallest_duration;
  }

  void collectWithoutCurrents(const StampInterval& span) {
    std::optional<SegmentAverage> average = averageOf(span);
    if (!average) {
      return;
    }
    Sample sample = *average->sample;
    if (sample.has_torque) {
      sample.has_torque = false;
      sample.torque.setZero();
      sample.torque_stddev = 0.0;
      note(span, "The torque is left out: no currents were measured.");
    }
    candidates_.push_back({sample, false, 0});
  }

  void collect(const CurrentSegment& segment, const StampInterval& steady) {
    std::optional<SegmentAverage> average = averageOf(steady);
    if (!average) {
      return;
    }
    const MeanCurrent current = meanCurrent(buffers_.currents, steady, segment, options_);
    if (current.count < static_cast<std::size_t>(options_.smallest_count)) {
      discard(steady, "It has only " + std::to_string(current.count) + " current measurements.");
      return;
    }
    average->sample->current = current.current;
    average->sample->measurements =
        std::min(average->sample->measurements, static_cast<std::uint32_t>(current.count));
    candidates_.push_back({*average->sample, segment.excited, average->torque_count});
  }

  /// Nothing, and an event, when the interval gives no sample.
  std::optional<SegmentAverage> averageOf(const StampInterval& interval) {
    SegmentAverage average = averageSegment(buffers_, interval, options_);
    if (average.sample) {
      average.sample->dwell = dwell_.begin;
    }
    report_.joints.glitches += average.joint_glitches;
    report_.orientations.glitches += average.orientation_glitches;
    report_.torques.glitches += average.torque_glitches;
    if (!average.sample) {
      discard(interval, average.refusal);
      return std::nullopt;
    }
    for (std::string& text : average.notes) {
      note(interval, std::move(text));
    }
    return average;
  }

  void removeBias() {
    const auto needs_removal = [](const Candidate& candidate) {
      return candidate.excited && candidate.sample.has_torque;
    };
    if (std::none_of(candidates_.begin(), candidates_.end(), needs_removal)) {
      return;
    }
    const ZeroCurrentPart zero = zeroCurrentPart();
    if (zero.weight == 0.0) {
      note(dwell_, "The torque bias is not removed: the dwell has no part without current.");
      return;
    }
    for (Candidate& candidate : candidates_) {
      Sample& sample = candidate.sample;
      if (needs_removal(candidate)) {
        sample.torque -= zero.torque;
        sample.current -= zero.current;
        sample.torque_shared_stddev = std::sqrt(zero.torque_variance);
        sample.torque_stddev = std::hypot(sample.torque_stddev, sample.torque_shared_stddev);
      } else if (!candidate.excited) {
        sample.has_torque = false;
        sample.torque.setZero();
        sample.torque_stddev = 0.0;
      }
    }
  }

  /// Mean of the zero-current spans, each weighted by its number of torque measurements.
  ZeroCurrentPart zeroCurrentPart() const {
    ZeroCurrentPart part;
    part.current = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(buffers_.currents.width()));
    for (const Candidate& candidate : candidates_) {
      if (candidate.excited || !candidate.sample.has_torque) {
        continue;
      }
      const Sample& sample = candidate.sample;
      const auto weight = static_cast<double>(candidate.torque_count);
      part.weight += weight;
      part.torque += weight * sample.torque;
      part.current += weight * sample.current;
      part.torque_variance += weight * weight * sample.torque_stddev * sample.torque_stddev;
    }
    if (part.weight > 0.0) {
      part.torque /= part.weight;
      part.current /= part.weight;
      part.torque_variance /= part.weight * part.weight;
    }
    return part;
  }

  const MeasurementBuffers& buffers_;
  StampInterval dwell_;
  StampInterval rest_;  ///< the dwell without settling and guard
  const SampleBuilderOptions& options_;
  SampleBuilderReport& report_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::vector<Sample> samplesOfDwell(const MeasurementBuffers& buffers,
                                   const StampInterval& dwell,
                                   const SampleBuilderOptions& options,
                                   SampleBuilderReport& report) {
  return DwellSampler(buffers, dwell, options, report).samples();
}

std::vector<StampInterval> stretchesOfDwell(const MeasurementBuffers& buffers,
                                            const StampInterval& dwell,
                                            const SampleBuilderOptions& options) {
  SampleBuilderReport report;
  return DwellSampler(buffers, dwell, options, report).stretches();
}

std::optional<Sample> sampleOfSpan(const MeasurementBuffers& buffers,
                                   const StampInterval& dwell,
                                   const StampInterval& span,
                                   const SampleBuilderOptions& options,
                                   SampleBuilderReport& report) {
  return DwellSampler(buffers, dwell, options, report).sampleOf(span);
}

}  // namespace sac
