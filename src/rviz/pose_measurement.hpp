#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sac {

/// What a capture gave.
struct CaptureOutcome {
  enum class Flaw {
    kNone,
    kExcitation,       ///< coils do not carry what is commanded
    kRestInterrupted,  ///< the torque without current is to be measured anew
    kOther,
  };
  bool success = false;
  std::string message;  ///< one sentence
  Flaw flaw = Flaw::kNone;
};

/// Measures a pose: excites coils in turn, and has each captured. What a sample must be, and when
/// coils carry their current, is for the calibration node to decide: where it tells that they do
/// not, it is asked again for a while; where the rest was interrupted, that begins with its zero
/// again. Who asks it publishes and calls. Knows no windows. Times by a steady clock.
class PoseMeasurement {
 public:
  /// What is to be done now.
  enum class Action { kNothing, kCapture, kEnd };

  /// The least current to excite a coil with [A], as the calibration node tells
  /// (CalibrationStatus).
  void requireAtLeast(double current) { least_ = current; }

  /// `patterns`: coils counted from 1, in turn; 0: none, which comes first in any case. `current`
  /// [A] in each; it ends at once where that is too little.
  void begin(std::vector<std::uint32_t> patterns, double current, double now);
  bool isRunning() const { return place_ < patterns_.size(); }

  /// kCapture is told once for each capture.
  Action step(double now);
  /// To a capture that was asked for. What else failed ends the measurement.
  void captured(const CaptureOutcome& outcome, double now);
  void end(const std::string& reason);

  /// To be commanded now: the coil, counted from 1, or 0, and its current [A].
  std::uint32_t coil() const { return isRunning() ? patterns_[place_] : 0; }
  double current() const { return coil() == 0 ? 0.0 : current_; }
  /// Why it ended, or what was measured, in a sentence.
  const std::string& outcome() const { return outcome_; }

 private:
  void beginPattern(double now);
  void advance(double now);

  double least_ = 0.0;
  std::vector<std::uint32_t> patterns_;
  std::size_t place_ = 0;
  double current_ = 0.0;
  double began_ = 0.0;
  double next_ = 0.0;  ///< when it is captured, or captured again
  bool is_asked_ = false;
  std::size_t samples_ = 0;  ///< that are kept
  std::string outcome_;
};

}  // namespace sac
