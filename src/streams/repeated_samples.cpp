#include "repeated_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "current_segments.hpp"
#include "dwell_samples.hpp"
#include "spherical_actuator_calibration/streams/dwell_detector.hpp"

namespace sac {
namespace {

/// What a sample was averaged over. A duration that no dwell has is not of such streams: whatever
/// it is made of, nothing will be found there.
StampInterval spanOf(const Sample& sample, const SampleBuilderOptions& options) {
  const double duration = std::isfinite(sample.duration) ? sample.duration : 0.0;
  const Stamp ticks = ticksFromSeconds(std::clamp(duration, 0.0, options.largest_dwell));
  const Stamp begin = sample.stamp - ticks / 2;
  return {begin, begin + ticks};
}

/// Where the rotor rests around a span, within `limits`; nothing where it moves in the span, or is
/// not measured.
std::optional<StampInterval> restAround(const StampInterval& span,
                                        const StampInterval& limits,
                                        const StreamBuffer& joints,
                                        const SampleBuilderOptions& options) {
  SampleBuilderOptions uncut = options;
  uncut.largest_dwell = std::numeric_limits<std::int32_t>::max();
  DwellDetector detector(uncut);
  const auto clipped = [&](const StampInterval& rest) {
    return StampInterval{std::max(rest.begin, limits.begin), std::min(rest.end, limits.end)};
  };
  // The readings before tell whether the first one within the limits is a glitch.
  const Stamp before = ticksFromSeconds(options.largest_gap);
  const StreamBuffer::Range range =
      joints.within({limits.begin - before, std::numeric_limits<Stamp>::max()});
  for (std::size_t index = range.first; index < range.last; ++index) {
    const auto ended = detector.add(joints.stamp(index), joints.values(index));
    if (ended && ended->end > span.begin) {
      return ended->begin < span.end ? std::optional(clipped(*ended)) : std::nullopt;
    }
    if (detector.present() && detector.present()->end >= limits.end) {
      break;
    }
  }
  const auto& present = detector.present();
  return present && present->begin < span.end && present->end > span.begin
             ? std::optional(clipped(*present))
             : std::nullopt;
}

}  // namespace

RepeatedSamples::RepeatedSamples(const std::vector<Sample>& taken,
                                 const SampleBuilderOptions& options)
    : options_(options),
      settle_after_motion_(ticksFromSeconds(options.settle_after_motion)),
      guard_before_motion_(ticksFromSeconds(options.guard_before_motion)) {
  for (const Sample& sample : taken) {
    taken_.push_back({sample, spanOf(sample, options)});
  }
  std::stable_sort(taken_.begin(), taken_.end(), [](const Taken& a, const Taken& b) {
    return a.span.end < b.span.end;
  });
}

// However long it is said to have rested, no more is held than of any dwell.
Stamp RepeatedSamples::beginOf(const Taken& taken) const {
  const Stamp earliest =
      taken.span.end + guard_before_motion_ - ticksFromSeconds(options_.largest_dwell);
  return std::max(taken.sample.dwell, earliest);
}

Stamp RepeatedSamples::oldestNeeded() const {
  return beginOf(taken_[next_]) - ticksFromSeconds(options_.largest_gap);
}

std::vector<Sample> RepeatedSamples::upTo(Stamp until,
                                          const std::optional<StampInterval>& dwell,
                                          const MeasurementBuffers& buffers,
                                          SampleBuilderReport& report) {
  std::vector<Sample> samples;
  for (; !empty() && taken_[next_].span.end <= until; ++next_) {
    const Taken& taken = taken_[next_];
    std::optional<Sample> sample;
    if (dwell) {
      sample = ofWholeDwell(taken, *dwell, buffers);
    }
    if (!sample) {
      sample = asCaptured(taken, buffers, report);
    }
    if (sample) {
      sample->id = taken.sample.id;
      sample->validation = taken.sample.validation;
      samples.push_back(std::move(*sample));
    }
  }
  report.samples += samples.size();
  return samples;
}

std::optional<Sample> RepeatedSamples::ofWholeDwell(const Taken& taken,
                                                    const StampInterval& dwell,
                                                    const MeasurementBuffers& buffers) {
  const StampInterval whole{std::max(dwell.begin, beginOf(taken)), dwell.end};
  if (whole.begin != whole_dwell_.begin || whole.end != whole_dwell_.end) {
    const std::vector<StampInterval> stretches = stretchesOfDwell(buffers, whole, options_);
    const bool is_end_of_one =
        std::any_of(stretches.begin(), stretches.end(), [&](const StampInterval& stretch) {
          return stretch.end == taken.span.end;
        });
    if (!is_end_of_one) {
      return std::nullopt;
    }
    SampleBuilderReport report;
    of_whole_dwell_ = samplesOfDwell(buffers, whole, options_, report);
    whole_dwell_ = whole;
  }
  for (const Sample& sample : of_whole_dwell_) {
    // No capture ends there but by chance: it does not know of the end.
    if (spanOf(sample, options_).end == taken.span.end) {
      return sample;
    }
  }
  return std::nullopt;
}

std::optional<Sample> RepeatedSamples::asCaptured(const Taken& taken,
                                                  const MeasurementBuffers& buffers,
                                                  SampleBuilderReport& report) const {
  const std::optional<Stretch> stretch = stretchOf(taken, buffers);
  if (!stretch) {
    report.add({DwellEvent::Kind::kDiscarded,
                taken.span.middle(),
                "Sample " + std::to_string(taken.sample.id) +
                    ": the streams show no rest of the rotor there."});
    return std::nullopt;
  }
  return sampleOfSpan(buffers, stretch->dwell, stretch->span, options_, report);
}

std::optional<RepeatedSamples::Stretch> RepeatedSamples::stretchOf(
    const Taken& taken, const MeasurementBuffers& buffers) const {
  const StampInterval limits{beginOf(taken), taken.span.end + guard_before_motion_};
  const auto rest = restAround(taken.span, limits, buffers.joints, options_);
  if (!rest) {
    return std::nullopt;
  }
  StampInterval span{std::max(taken.span.begin, rest->begin + settle_after_motion_),
                     std::min(taken.span.end, rest->end - guard_before_motion_)};
  for (const CurrentSegment& segment :
       segmentsOfConstantCurrent(buffers.currents, *rest, options_)) {
    if (segment.span.begin < span.end) {
      span.begin = std::max(
          span.begin, segment.span.begin + ticksFromSeconds(options_.settle_after_current_change));
    }
  }
  return Stretch{*rest, span};
}

}  // namespace sac
