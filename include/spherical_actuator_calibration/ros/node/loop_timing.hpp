#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>

namespace sac {

/// One turn of a loop that makes something of what came: a command of a reading, a request of a
/// command.
struct LoopTurn {
  double begin = 0.0;  ///< of the work, by a clock that never jumps [s]
  double end = 0.0;    ///< likewise [s]
  /// Of what it is made of [s]; nothing: of nothing new.
  std::optional<double> age;
  /// Between that and what came before it, by their stamps [s]; 0: not known.
  double interval = 0.0;
};

/// How steadily the turns came and how fresh what they are made of was, over some time.
struct TimingReport {
  std::size_t turns = 0;
  double rate = 0.0;              ///< of the turns [Hz]
  double jitter = 0.0;            ///< standard deviation of their period [s]
  double longest_period = 0.0;    ///< [s]
  double mean_age = 0.0;          ///< [s]
  double largest_age = 0.0;       ///< [s]
  double mean_duration = 0.0;     ///< of the work [s]
  double longest_duration = 0.0;  ///< likewise [s]
};

/// Keeps account of a loop that follows what comes. Not thread-safe.
class LoopTiming {
 public:
  void add(const LoopTurn& turn);
  /// The next turn does not follow the last one.
  void interrupt() { last_begin_.reset(); }

  /// Of the turns since this was called last.
  TimingReport take();

  /// Since the start.
  std::size_t turns() const { return turns_; }
  /// Likewise, of those on something so old that the next one is usually there.
  std::size_t oldTurns() const { return old_turns_; }

 private:
  /// Sums that take() makes a report of.
  struct Sums {
    std::size_t turns = 0;
    std::size_t periods = 0;
    std::size_t ages = 0;
    double period = 0.0;         ///< [s]
    double period_square = 0.0;  ///< [s²]
    double age = 0.0;            ///< [s]
    double duration = 0.0;       ///< [s]
  };

  void noteAge(double age, double interval);

  Sums sums_;
  TimingReport largest_;  ///< of which the largest values are kept
  std::optional<double> last_begin_;
  std::optional<double> usual_interval_;  ///< of what comes [s]
  std::size_t turns_ = 0;
  std::size_t old_turns_ = 0;
};

/// Adds a report [us] to what /diagnostics tells. `what` has the age, "reading", and `work` the
/// duration, "computation".
void addTiming(diagnostic_updater::DiagnosticStatusWrapper& status,
               const TimingReport& report,
               const std::string& what,
               const std::string& work);

/// The timing of a driver's loop for /diagnostics, under "timing": rates and ages are those since
/// the call before. Thread-safe.
class TimingDiagnostics : public diagnostic_updater::DiagnosticTask {
 public:
  /// As for addTiming(); `turns`: what there was of them, "beats".
  TimingDiagnostics(std::string turns, std::string what, std::string work);

  void add(const LoopTurn& turn);
  void interrupt();
  void run(diagnostic_updater::DiagnosticStatusWrapper& status) override;

 private:
  const std::string turns_;
  const std::string what_;
  const std::string work_;
  std::mutex mutex_;
  LoopTiming timing_;
};

}  // namespace sac
