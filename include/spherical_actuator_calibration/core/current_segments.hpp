#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/core/sample_builder_options.hpp"
#include "spherical_actuator_calibration/core/stream_buffer.hpp"

namespace spherical_actuator_calibration {

/// Span of constant current in every coil.
struct CurrentSegment {
  StampInterval span;       ///< from its first to its last current measurement
  bool excited = false;     ///< a coil's mean current reaches the threshold
  Eigen::VectorXd current;  ///< mean measured current per coil [A]
};

/// Cuts a dwell into spans of constant current, in order. A span ends where a coil leaves
/// ± `current_tolerance` or the stream has a hole longer than `largest_gap`; one deviating
/// measurement between two that agree is passed over. Ramps fall into spans that are too short to
/// use.
std::vector<CurrentSegment> segmentsOfConstantCurrent(const StreamBuffer& currents,
                                                      const StampInterval& dwell,
                                                      const SampleBuilderOptions& options);

}  // namespace spherical_actuator_calibration
