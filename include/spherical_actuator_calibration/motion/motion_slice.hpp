#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// One window with what its momentum balance needs beside it, and the orientations whose stamps are
/// within it.
struct MotionSlice {
  MotionStreams streams;
  WindowRange window;
};

/// Throws DataError unless a slice, wherever it comes from, is as a MotionSlicer cuts it.
void validate(const MotionSlice& slice, std::size_t coils, const MotionOptions& options);

/// Cuts windows out of streams as they come, one after the other. What is behind them is forgotten.
/// Measurements come in the order of their stamps, or nearly so.
class MotionSlicer {
 public:
  MotionSlicer(std::size_t coils, const MotionOptions& options);

  // What is not finite, or not later than the last of its kind, is dropped. A clock that was set
  // back, or a hole of half a second in the readings, begins anew.
  void add(const JointMeasurement& measurement);
  void add(const CurrentMeasurement& measurement);
  void add(const OrientationMeasurement& measurement);

  /// The next window that all streams have passed; none: wait for more. Those that cannot serve are
  /// skipped, and counted.
  std::optional<MotionSlice> take();
  /// Since the begin.
  const std::vector<WindowsLeftOut>& leftOut() const { return left_out_; }
  void forget();

 private:
  /// One stream, oldest first.
  template <typename Value>
  using Stream = std::deque<std::pair<Stamp, Value>>;

  template <typename Value>
  void push(Stream<Value>& stream, Stamp stamp, const Value& value);
  /// Reading at the end of the window that begins at `begin_`; none: it is not there yet.
  std::optional<std::size_t> end() const;
  MotionSlice cut(std::size_t end) const;
  void advance(std::size_t end);

  std::size_t coils_;
  MotionOptions options_;
  Stream<Eigen::Vector3d> joints_;
  Stream<Eigen::VectorXf> currents_;
  Stream<Eigen::Quaterniond> orientations_;
  std::size_t begin_;  ///< reading at which the next window begins
  std::vector<WindowsLeftOut> left_out_;
};

}  // namespace sac
