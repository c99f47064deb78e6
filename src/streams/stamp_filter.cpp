#include "spherical_actuator_calibration/streams/stamp_filter.hpp"

namespace sac {

StampFilter::StampFilter(const StampFilterOptions& options)
    : largest_gap_(ticksFromSeconds(options.largest_gap)),
      clock_reset_(ticksFromSeconds(options.clock_reset)),
      largest_jump_(ticksFromSeconds(options.largest_jump)) {}

StampFilter::Verdict StampFilter::judge(Stamp stamp) {
  Verdict verdict;
  if (stamp <= 0) {
    verdict.drop = DropReason::kUnstamped;
    return verdict;
  }
  if (!last_) {
    last_ = stamp;
    return verdict;
  }
  const Stamp step = stamp - *last_;
  if (step <= -clock_reset_ || step > largest_jump_) {
    return judgeJump(stamp);
  }
  if (step <= 0) {
    verdict.drop = step == 0 ? DropReason::kRepeated : DropReason::kLate;
    return verdict;
  }
  suspect_.reset();
  verdict.gap = step > largest_gap_;
  last_ = stamp;
  return verdict;
}

StampFilter::Verdict StampFilter::judgeJump(Stamp stamp) {
  Verdict verdict;
  const bool confirmed = suspect_ && stamp > *suspect_ && stamp - *suspect_ < clock_reset_;
  if (!confirmed) {
    suspect_ = stamp;
    verdict.drop = DropReason::kJump;
    return verdict;
  }
  verdict.clock_reset = stamp < *last_;
  verdict.gap = !verdict.clock_reset;
  suspect_.reset();
  last_ = stamp;
  return verdict;
}

void StampFilter::restart() {
  last_.reset();
  suspect_.reset();
}

}  // namespace sac
