#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sac {

/// Measures a pose: excites coils in turn, waits until they carry their current, and has each
/// captured. It decides; who asks it publishes and calls. Knows no windows. Times by a steady
/// clock.
class PoseMeasurement {
 public:
  /// What is to be done now.
  enum class Action { kNothing, kCapture, kEnd };

  /// `patterns`: coils counted from 1, in turn; 0: none. `current` [A] in each.
  void begin(std::vector<std::uint32_t> patterns, double current, double now);
  bool isRunning() const { return place_ < patterns_.size(); }

  /// `measured`: the last currents [A], one per coil. kCapture is told once for each pattern.
  Action step(const std::vector<double>& measured, double now);
  /// To a capture that was asked for. What failed ends the measurement.
  void answered(bool success, const std::string& message, double now);
  void end(const std::string& reason);

  /// To be commanded now: the coil, counted from 1, or 0, and its current [A].
  std::uint32_t coil() const { return isRunning() ? patterns_[place_] : 0; }
  double current() const { return coil() == 0 ? 0.0 : current_; }
  /// Why it ended, or what was measured, in a sentence.
  const std::string& outcome() const { return outcome_; }

 private:
  bool carries(const std::vector<double>& measured) const;
  void beginPattern(double now);

  std::vector<std::uint32_t> patterns_;
  std::size_t place_ = 0;
  double current_ = 0.0;
  double began_ = 0.0;
  double settled_ = -1.0;  ///< since when the currents are those wanted; negative: they are not
  bool is_asked_ = false;
  std::string outcome_;
};

}  // namespace sac
