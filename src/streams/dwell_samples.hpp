#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_report.hpp"
#include "spherical_actuator_calibration/streams/stream_buffer.hpp"

namespace sac {

/// Samples of one dwell, one per span of constant current, oldest first, ids 0.
///
/// With BiasRemoval::kZeroCurrent the mean torque and mean current of all zero-current spans of the
/// dwell are subtracted from those of each excited span; the variances add. Both are differences,
/// so that a torque bias and an offset of the current sensors go out together. A zero-current span
/// that served so carries an orientation only. Without a zero-current span the torque stays raw,
/// which is noted. A dwell without measured currents gives one sample without torque.
///
/// Appends to the events and counts glitches and samples in `report`.
std::vector<Sample> samplesOfDwell(const MeasurementBuffers& buffers,
                                   const StampInterval& dwell,
                                   const SampleBuilderOptions& options,
                                   SampleBuilderReport& report);

/// The spans that samplesOfDwell() averages, oldest first; not all of them give a sample.
std::vector<StampInterval> stretchesOfDwell(const MeasurementBuffers& buffers,
                                            const StampInterval& dwell,
                                            const SampleBuilderOptions& options);

/// Sample of one span of constant current within a dwell, id 0, averaged over all of the span. The
/// bias is taken from the zero-current spans of the dwell up to its end. Nothing, and an event with
/// the reason, when the span gives none.
std::optional<Sample> sampleOfSpan(const MeasurementBuffers& buffers,
                                   const StampInterval& dwell,
                                   const StampInterval& span,
                                   const SampleBuilderOptions& options,
                                   SampleBuilderReport& report);

}  // namespace sac
