#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace sac {

/// Why a measurement did not enter.
enum class DropReason {
  kUnstamped,  ///< stamp zero or negative
  kNotFinite,  ///< NaN or infinite
  kNotUnit,    ///< quaternion whose norm is off by more than 1e-3
  kWrongSize,  ///< not one current per coil
  kRepeated,   ///< stamp of the measurement before
  kLate,       ///< older than the measurement before
  kJump,       ///< stamp far from the one before, not confirmed by the next
  kBehind,     ///< older than the newest of all streams by more than the stream timeout
};
inline constexpr std::size_t kDropReasons = 8;

/// "not finite", "late" and so on.
const char* describe(DropReason reason);

/// What became of the measurements of one stream.
struct StreamStatistics {
  std::uint64_t received = 0;
  std::uint64_t accepted = 0;
  std::array<std::uint64_t, kDropReasons> dropped = {};  ///< by DropReason
  std::uint64_t gaps = 0;          ///< holes longer than SampleBuilderOptions::largest_gap
  std::uint64_t clock_resets = 0;  ///< steps back that the next measurement confirmed
  std::uint64_t glitches = 0;      ///< accepted, but left out of a mean as outliers

  std::uint64_t droppedFor(DropReason reason) const {
    return dropped[static_cast<std::size_t>(reason)];
  }
  std::uint64_t droppedInAll() const;
};

/// One line for people: "joint_states: 12000 received, 3 dropped (2 not finite, 1 repeated), 1
/// gap."
std::string describe(const std::string& stream, const StreamStatistics& statistics);

}  // namespace sac
