#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "spherical_actuator_calibration/motion/motion_recording.hpp"
#include "spherical_actuator_calibration/motion/motion_slice.hpp"

namespace sac {

/// What a rotor did lately: streams of a running laboratory, of which those stretches are kept in
/// which it moved with currents. The oldest ones make room for new ones.
class MotionMemory {
 public:
  /// `most_bytes`: of all stretches that are kept, roughly; seven minutes of 24 coils at 1 kHz.
  explicit MotionMemory(std::size_t coils, std::size_t most_bytes = 50'000'000);

  // What MotionRecorder::add() drops is dropped.
  void add(const JointMeasurement& measurement);
  void add(const CurrentMeasurement& measurement);
  void add(const OrientationMeasurement& measurement);
  void add(const CurrentCommand& command);

  /// What windows of an earlier memory hold, oldest first.
  void restore(const std::vector<MotionSlice>& windows);

  /// All that is kept, oldest first; the present stretch ends here.
  MotionRecording recording();
  void forget();

 private:
  void take(std::size_t bytes);
  void endStretch();

  std::size_t coils_;
  std::size_t most_bytes_;
  MotionRecorder recorder_;
  std::optional<Stamp> begin_;  ///< of the present stretch
  std::size_t bytes_ = 0;       ///< of the present stretch
  std::deque<MotionStreams> stretches_;
};

}  // namespace sac
