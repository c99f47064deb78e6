#pragma once

#include <optional>

#include "spherical_actuator_calibration/measurement/stamp_interval.hpp"
#include "spherical_actuator_calibration/streams/stream_statistics.hpp"

namespace sac {

/// Which steps of a stream's stamps are believed.
struct StampFilterOptions {
  double largest_gap = 0.25;   ///< a longer step is a hole in the stream [s]
  double clock_reset = 1.0;    ///< a step back by more starts the clock anew [s]
  double largest_jump = 10.0;  ///< a step ahead by more needs a confirmation [s]
};

/// Judges the stamps of one stream, in the order of arrival. Accepted stamps increase strictly
/// between resets of the clock. A step far back or far ahead is believed only when the next stamp
/// follows it closely, so that one wrong stamp costs one measurement.
class StampFilter {
 public:
  struct Verdict {
    std::optional<DropReason> drop;  ///< nothing: accepted
    bool clock_reset = false;        ///< accepted, as the first after a step back
    bool gap = false;                ///< accepted, after a hole
  };

  explicit StampFilter(const StampFilterOptions& options);

  Verdict judge(Stamp stamp);

  /// The next stamp may be anything: another recording begins.
  void restart();

 private:
  Verdict judgeJump(Stamp stamp);

  Stamp largest_gap_;
  Stamp clock_reset_;
  Stamp largest_jump_;
  std::optional<Stamp> last_;     ///< newest accepted
  std::optional<Stamp> suspect_;  ///< waits for a confirmation
};

}  // namespace sac
