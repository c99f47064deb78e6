#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"
#include "spherical_actuator_calibration/streams/stream_buffer.hpp"

namespace sac {

/// One sample out of the measurements of an interval, or the reason why there is none.
struct SegmentAverage {
  std::optional<Sample> sample;
  std::string refusal;             ///< one sentence; empty with a sample
  std::vector<std::string> notes;  ///< what limits the sample, one sentence each
  std::size_t torque_count = 0;    ///< torque measurements averaged
  std::size_t joint_glitches = 0;  ///< measurements left out as outliers
  std::size_t orientation_glitches = 0;
  std::size_t torque_glitches = 0;
};

/// Averages what the streams hold of an interval in which the currents are constant. The sample has
/// id 0, no currents, and the raw mean torque; `measurements` is the smallest number averaged among
/// the quantities that it carries. A quantity with fewer than `smallest_count` measurements is left
/// out and noted. Refused: an interval that is too short, too few joint measurements, joints or a
/// measured orientation that move, and a sample with neither orientation nor torque.
SegmentAverage averageSegment(const MeasurementBuffers& buffers,
                              const StampInterval& interval,
                              const SampleBuilderOptions& options);

}  // namespace sac
