#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sac {

/// When a coil carries what is commanded, as the calibration node says (CalibrationStatus).
struct CurrentRule {
  double tolerance = 0.0;  ///< [A]
  double share = 0.0;      ///< of the command, where that is more [1]
  double least = 0.0;      ///< to excite a coil with [A]

  bool allows(double measured, double commanded) const;
};

/// What a capture gave.
struct CaptureOutcome {
  bool success = false;
  std::string message;            ///< one sentence
  bool rest_interrupted = false;  ///< the torque without current is to be measured anew
};

/// Measures a pose: excites coils in turn, waits until they carry their current, and has each
/// captured. What a sample must be is for the calibration node to decide; where it tells that the
/// rest was interrupted, that begins with its zero again. Who asks it publishes and calls. Knows no
/// windows. Times by a steady clock.
class PoseMeasurement {
 public:
  /// What is to be done now.
  enum class Action { kNothing, kCapture, kEnd };

  void judgeBy(const CurrentRule& rule) { rule_ = rule; }

  /// `patterns`: coils counted from 1, in turn; 0: none, which comes first in any case. `current`
  /// [A] in each; it ends at once where that is too little.
  void begin(std::vector<std::uint32_t> patterns, double current, double now);
  bool isRunning() const { return place_ < patterns_.size(); }

  /// `measured`: the last currents [A], one per coil. kCapture is told once for each pattern.
  Action step(const std::vector<double>& measured, double now);
  /// To a capture that was asked for. What else failed ends the measurement.
  void captured(const CaptureOutcome& outcome, double now);
  void end(const std::string& reason);

  /// To be commanded now: the coil, counted from 1, or 0, and its current [A].
  std::uint32_t coil() const { return isRunning() ? patterns_[place_] : 0; }
  double current() const { return coil() == 0 ? 0.0 : current_; }
  /// Why it ended, or what was measured, in a sentence.
  const std::string& outcome() const { return outcome_; }

 private:
  bool carries(const std::vector<double>& measured) const;
  void beginPattern(double now);
  void advance(double now);

  CurrentRule rule_;
  std::vector<std::uint32_t> patterns_;
  std::size_t place_ = 0;
  double current_ = 0.0;
  double began_ = 0.0;
  double settled_ = -1.0;  ///< since when the currents are those wanted; negative: they are not
  bool is_asked_ = false;
  std::size_t samples_ = 0;  ///< that are kept
  std::string outcome_;
};

}  // namespace sac
