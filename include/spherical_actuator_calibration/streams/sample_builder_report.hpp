#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/streams/stream_statistics.hpp"

namespace sac {

/// Something that an operator may want to know about one dwell or segment.
struct DwellEvent {
  enum class Kind {
    kDiscarded,  ///< no sample was made
    kNote,       ///< a sample was made; this limits it
  };
  Kind kind = Kind::kNote;
  Stamp stamp = 0;     ///< middle of the dwell or segment
  std::string reason;  ///< one sentence
};

/// What SampleBuilder did with its input.
struct SampleBuilderReport {
  /// Further events are counted only, so that memory stays bounded.
  static constexpr std::size_t kMaxEvents = 1000;

  StreamStatistics joints;
  StreamStatistics orientations;
  StreamStatistics torques;
  StreamStatistics currents;
  std::uint64_t dwells = 0;     ///< spans of rest seen
  std::uint64_t samples = 0;    ///< made from them
  std::uint64_t discarded = 0;  ///< dwells and segments without a sample
  std::vector<DwellEvent> events;
  std::uint64_t events_untold = 0;  ///< beyond kMaxEvents

  void add(DwellEvent event);
};

}  // namespace sac
