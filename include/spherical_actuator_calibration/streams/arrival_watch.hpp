#pragma once

#include <cstdint>

namespace sac {

/// How long no measurement has arrived, by looks at how many have. The clock is given by the caller
/// and never goes back. A step of it beyond kLongestStep counts as that: nothing could arrive while
/// this process stood still, and what came meanwhile is still to be received.
class ArrivalWatch {
 public:
  static constexpr double kLongestStep = 0.1;  ///< [s]

  ArrivalWatch(std::uint64_t received, double now) : received_(received), last_look_(now) {}

  /// Whether something has arrived since the look before.
  bool look(std::uint64_t received, double now);

  /// Since the last arrival, as of the last look [s].
  double silence() const { return silence_; }

 private:
  std::uint64_t received_;
  double last_look_;
  double silence_ = 0.0;
};

}  // namespace sac
