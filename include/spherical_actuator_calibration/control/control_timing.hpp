#pragma once

#include <cstddef>
#include <optional>

namespace sac {

/// When one command was made.
struct CommandTime {
  double begin = 0.0;        ///< of the computation, by a clock that never jumps [s]
  double end = 0.0;          ///< likewise [s]
  double reading_age = 0.0;  ///< of the joint reading that it is made of, at its begin [s]
  /// Between that reading and the one before, by their stamps [s]; 0: there is none before.
  double reading_interval = 0.0;
};

/// How steadily commands came and how fresh their readings were, over some time.
struct TimingReport {
  std::size_t commands = 0;
  double rate = 0.0;                 ///< of the commands [Hz]
  double jitter = 0.0;               ///< standard deviation of their period [s]
  double longest_period = 0.0;       ///< [s]
  double mean_age = 0.0;             ///< of the readings [s]
  double largest_age = 0.0;          ///< of the readings [s]
  double mean_computation = 0.0;     ///< [s]
  double longest_computation = 0.0;  ///< [s]
};

/// Keeps account of the commands of a control that follows its readings. Not thread-safe.
class ControlTiming {
 public:
  void add(const CommandTime& command);
  /// The next command does not follow the last one.
  void interrupt() { last_begin_.reset(); }

  /// Of the commands since this was called last.
  TimingReport take();

  /// Since the start.
  std::size_t commands() const { return commands_; }
  /// Likewise, of readings that were so old that the next one is usually there.
  std::size_t oldReadings() const { return old_readings_; }

 private:
  /// Sums that take() makes a report of.
  struct Sums {
    std::size_t commands = 0;
    std::size_t periods = 0;
    double period = 0.0;         ///< [s]
    double period_square = 0.0;  ///< [s²]
    double age = 0.0;            ///< [s]
    double computation = 0.0;    ///< [s]
  };

  void noteReading(double age, double interval);

  Sums sums_;
  TimingReport largest_;  ///< of which the largest values are kept
  std::optional<double> last_begin_;
  std::optional<double> usual_interval_;  ///< of readings [s]
  std::size_t commands_ = 0;
  std::size_t old_readings_ = 0;
};

}  // namespace sac
