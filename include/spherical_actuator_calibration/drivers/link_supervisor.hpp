#pragma once

#include <cstdint>
#include <string>

namespace sac {

/// How long to wait before a lost device is tried again: doubled after each failure [s].
struct BackOff {
  double first = 0.1;
  double largest = 2.0;
};

/// Decides when a link is opened again after it was lost, and counts what happened. Times are
/// seconds of a steady clock of the caller.
class LinkSupervisor {
 public:
  explicit LinkSupervisor(const BackOff& back_off = {}) : back_off_(back_off) {}

  /// True after success() until failure().
  bool isUp() const { return is_up_; }
  /// Whether a lost link should be tried at this time.
  bool mayTry(double now) const { return is_up_ || now >= next_try_; }

  /// A request was answered.
  void success();
  /// Opening or a request failed, with the reason.
  void failure(double now, const std::string& reason);

  /// How often an established link came back after a loss.
  std::uint64_t reconnects() const { return reconnects_; }
  std::uint64_t failures() const { return failures_; }
  /// Reason of the last failure; empty before the first.
  const std::string& lastError() const { return last_error_; }

 private:
  BackOff back_off_;
  bool is_up_ = false;
  bool was_up_ = false;
  double next_try_ = 0.0;
  double wait_ = 0.0;
  std::uint64_t reconnects_ = 0;
  std::uint64_t failures_ = 0;
  std::string last_error_;
};

}  // namespace sac
