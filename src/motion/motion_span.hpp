#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "joint_track.hpp"
#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// A window has at least so many readings.
constexpr std::size_t kLeastReadings = 12;

/// Readings on either side of a window, for what is interpolated there.
constexpr std::size_t kBeside = 2;

/// One span of a recording, with times in seconds from its first reading.
struct MotionSpan {
  explicit MotionSpan(const MotionStreams& recorded);

  const MotionStreams* streams;
  JointTrack track;
  StampTimes current_times;
  StampTimes orientation_times;
  double current_step;  ///< usual
};

/// A stretch of readings without holes, over which momentum is balanced.
struct MotionWindow {
  std::size_t span = 0;
  std::size_t first = 0;  ///< reading at the begin
  std::size_t last = 0;   ///< reading at the end
};

/// Cuts windows one after the other, without a rest at the end, out of what has currents, also
/// within their largest delay. Those with holes, or in which the rotor rests, are added to
/// `left_out`.
std::vector<MotionWindow> cutWindows(const std::vector<MotionSpan>& spans,
                                     const MotionOptions& options,
                                     std::vector<WindowsLeftOut>& left_out);

/// Those in which a coil carries a fiftieth of the largest current that is usual in a window. In
/// the others something else moves the rotor, as a fixture between dwells: they are added to
/// `left_out`.
std::vector<MotionWindow> drivenWindows(const std::vector<MotionSpan>& spans,
                                        const std::vector<MotionWindow>& windows,
                                        std::vector<WindowsLeftOut>& left_out);

/// How currents follow commands in the span with most currents of those where that is known.
std::optional<CommandResponse> responseOfLongest(const std::vector<MotionSpan>& spans);

/// Why a window cannot serve; empty: it can.
std::string refusalOf(const MotionSpan& span,
                      const MotionWindow& window,
                      const MotionOptions& options);

/// Whether the rotor turns at no more than a speed around a time of a span: what is measured then
/// is of a dwell, if of anything.
bool restsAt(const MotionSpan& span, double time, double least_speed);

/// Counts one more window left out for a reason.
void countLeftOut(const std::string& reason, std::vector<WindowsLeftOut>& left_out);

}  // namespace sac
