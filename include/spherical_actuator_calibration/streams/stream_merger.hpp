#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <variant>

#include "spherical_actuator_calibration/measurement/measurements.hpp"

namespace sac {

/// A measurement of any stream.
using AnyMeasurement =
    std::variant<JointMeasurement, OrientationMeasurement, TorqueMeasurement, CurrentMeasurement>;

/// Puts measurements that arrive live into the order of their stamps. Every stream has a connection
/// of its own: when the computer was busy for a while, what waited in one of them arrives in a lump
/// before what waited in the next, and the second would be late by the time that the computer was
/// busy. Here it only has to arrive at most kPatience after the first.
///
/// Arrival is in seconds of a clock that never goes back, given by the caller in any call. A step
/// of it beyond kLongestStep counts as that: nothing could arrive while this process stood still.
class StreamMerger {
 public:
  /// How long a measurement waits for those of other streams [s].
  static constexpr double kPatience = 0.2;
  /// A stream that is silent for longer is not waited for [s].
  static constexpr double kSilence = 1.0;
  static constexpr double kLongestStep = 0.05;  ///< [s]

  /// A step back of stamps by `clock_reset` [s] or more begins another round, a smaller one is a
  /// late measurement, as of SampleBuilderOptions, but at the first stamp: what waits is soon let
  /// go.
  explicit StreamMerger(double clock_reset);

  void add(AnyMeasurement measurement, double now);

  /// The next measurement in order; nothing while an older one may still arrive.
  std::optional<AnyMeasurement> next(double now);
  /// The next measurement in order, although older ones may still arrive.
  std::optional<AnyMeasurement> nextAtOnce();

 private:
  struct Waiting {
    AnyMeasurement measurement;
    Stamp stamp;
    int round;
    double arrival;
  };
  struct Stream {
    std::deque<Waiting> waiting;
    std::optional<double> last_arrival;
    Stamp last_stamp = 0;
    /// How often its stamps were set back: a recording that is played in a loop. Not all streams
    /// begin the next round at the same moment.
    int round = 0;
  };

  void advance(double now);
  Stream* first();
  bool isComplete() const;
  bool patienceIsOver() const;
  void forgetRounds();

  double clock_reset_;
  std::array<Stream, std::variant_size_v<AnyMeasurement>> streams_;
  std::optional<double> last_now_;
  double clock_ = 0.0;  ///< time in which measurements could arrive [s]
};

}  // namespace sac
