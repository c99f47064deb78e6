#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/measurement/stamp_interval.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_report.hpp"
#include "spherical_actuator_calibration/streams/stream_buffer.hpp"

namespace sac {

/// Samples that were taken live, to be made again of a recording of the same streams: each over the
/// stretch that was averaged then, with the bias of as much of its rest as was known then. With the
/// options of then they come out the same; with other options as those tell.
class RepeatedSamples {
 public:
  /// `taken`: with stamp, duration and dwell; their values do not matter. Options as validated.
  RepeatedSamples(const std::vector<Sample>& taken, const SampleBuilderOptions& options);

  bool empty() const { return next_ == taken_.size(); }

  /// No older measurement is needed any more. Precondition: not empty.
  Stamp oldestNeeded() const;

  /// Those that end at `until` at the latest, as far as the buffers hold them; for each of the
  /// others an event with the reason. `dwell`: a rest that is over, if one is; a sample that was
  /// taken of it by itself when it was over is made so again.
  std::vector<Sample> upTo(Stamp until,
                           const std::optional<StampInterval>& dwell,
                           const MeasurementBuffers& buffers,
                           SampleBuilderReport& report);

 private:
  struct Taken {
    Sample sample;
    StampInterval span;
  };
  /// What a sample is made of.
  struct Stretch {
    StampInterval dwell;
    StampInterval span;
  };

  Stamp beginOf(const Taken& taken) const;
  std::optional<Sample> ofWholeDwell(const Taken& taken,
                                     const StampInterval& dwell,
                                     const MeasurementBuffers& buffers);
  std::optional<Sample> asCaptured(const Taken& taken,
                                   const MeasurementBuffers& buffers,
                                   SampleBuilderReport& report) const;
  std::optional<Stretch> stretchOf(const Taken& taken, const MeasurementBuffers& buffers) const;

  SampleBuilderOptions options_;
  Stamp settle_after_motion_;
  Stamp guard_before_motion_;
  std::vector<Taken> taken_;  ///< in the order of their ends
  std::size_t next_ = 0;
  // All samples of the dwell that was looked at last: others are likely to be among them.
  StampInterval whole_dwell_;
  std::vector<Sample> of_whole_dwell_;
};

}  // namespace sac
