#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/motion/motion_streams.hpp"

namespace sac {

/// Readings at the begin and at the end of a window.
struct WindowRange {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// What a rotor did while it moved: spans with clocks of their own, as of several recordings.
struct MotionRecording {
  std::vector<MotionStreams> spans;
  std::size_t dropped = 0;  ///< measurements that were not finite, or out of order
  /// The only one of each span, where all are slices of a MotionSlicer; else empty: windows are to
  /// be cut.
  std::vector<WindowRange> windows;

  bool empty() const { return spans.empty(); }
};

/// For how long a rotor did what [s].
struct MotionTimes {
  double all = 0.0;
  double motion = 0.0;         ///< the joints turned
  double driven = 0.0;         ///< some coil was on
  double driven_motion = 0.0;  ///< both
};

/// Of streams of one recording.
MotionTimes timesOf(const MotionStreams& streams);

/// Whether a rotor moves with currents, so that the recording is one of motion rather than dwells:
/// it turns for most of the time, and nothing else would tell the torque.
bool tellsMotion(const MotionRecording& recording);

/// Collects streams as they come.
class MotionRecorder {
 public:
  explicit MotionRecorder(std::size_t coils) : coils_(coils) {}

  // What is not finite, not later than the last of its kind, or beyond a million of it, is dropped
  // and counted. Two in a row that are a second and more before the last are of a clock that was
  // set back, or the last was wrong: another span begins, as it does where nothing came for long.
  void add(const JointMeasurement& measurement);
  void add(const CurrentMeasurement& measurement);
  void add(const OrientationMeasurement& measurement);
  /// What was commanded; need not be known. A command that is out of order is dropped.
  void add(const CurrentCommand& command);

  /// No more measurements of this base of time follow.
  void finish();
  /// All spans with joint angles and currents so far.
  MotionRecording take();

 private:
  /// Of one kind of measurement.
  struct Sequence {
    std::size_t taken = 0;         ///< since finish()
    std::optional<Stamp> earlier;  ///< the last one, when it was far before the one taken last
  };

  bool isCurrent(const Eigen::VectorXd& current) const;
  bool isNext(Sequence& sequence, const LongSeries<Stamp>& stamps, Stamp stamp, bool is_fine);
  static bool isSetBack(Sequence& sequence, Stamp last, Stamp stamp);
  bool isAfterPause(Stamp stamp) const;
  void endSpan();

  std::size_t coils_;
  Sequence joints_;
  Sequence orientations_;
  Sequence coil_currents_;
  MotionStreams streams_;
  CommandStream commands_;
  MotionRecording recording_;
};

}  // namespace sac
