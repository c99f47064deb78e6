#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"
#include "spherical_actuator_calibration/streams/stream_buffer.hpp"

namespace sac {

/// Span of constant current in every coil.
struct CurrentSegment {
  StampInterval span;       ///< from its first to its last current measurement
  bool excited = false;     ///< a coil's mean current reaches the threshold
  Eigen::VectorXd current;  ///< mean measured current per coil over the span [A]
};

/// Cuts a dwell into spans of constant current, in order. A span ends where a coil leaves
/// ± `current_tolerance` or the stream has a hole longer than `largest_gap`; one deviating
/// measurement between two that agree is passed over. Ramps fall into spans that are too short to
/// use.
std::vector<CurrentSegment> segmentsOfConstantCurrent(const StreamBuffer& currents,
                                                      const StampInterval& dwell,
                                                      const SampleBuilderOptions& options);

/// Mean current per coil over an interval, and how many measurements it is made of.
struct MeanCurrent {
  Eigen::VectorXd current;  ///< [A]
  std::size_t count = 0;
};

/// Mean of the measurements in the interval that agree with the segment's mean within twice
/// `current_tolerance`: those that were passed over stay out.
MeanCurrent meanCurrent(const StreamBuffer& currents,
                        const StampInterval& interval,
                        const CurrentSegment& segment,
                        const SampleBuilderOptions& options);

}  // namespace sac
