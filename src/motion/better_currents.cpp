#include "spherical_actuator_calibration/motion/better_currents.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "joint_track.hpp"
#include "stamp_times.hpp"

namespace sac {
namespace {

/// Whether windows fit another estimate no worse, and no fewer of them. Both are of the same
/// noise, so that little tells.
bool fitsAsWell(const MotionEstimate& other, const MotionEstimate& found) {
  constexpr double kLeastOfThem = 0.95;
  constexpr double kAsWell = 1.005;
  const auto is_told = [](const MotionEstimate& estimate) {
    return estimate.estimate.termination == Termination::kConverged;
  };
  if (!is_told(other) || !is_told(found)) {
    return is_told(other);
  }
  return static_cast<double>(other.summary.used) >=
             kLeastOfThem * static_cast<double>(found.summary.used) &&
         other.summary.window_chi_square < kAsWell * found.summary.window_chi_square;
}

/// Steps that commands do not tell well come at a beat of the driver's own, which may be anywhere
/// between two samples: residuals of the search know nothing of that.
CommandResponse atLeastUncertain(CommandResponse response, const MotionStreams& streams) {
  const StampTimes times(streams.current_stamps.front(), streams.current_stamps);
  const double anywhere = usualStep(times) / std::sqrt(12.0);
  response.lateness_stddev = std::max(response.lateness_stddev, anywhere);
  return response;
}

}  // namespace

std::optional<MotionRecording> byCommands(const MotionRecording& recording) {
  const auto is_commanded = [](const MotionStreams& streams) {
    return streams.commanded != nullptr;
  };
  if (std::none_of(recording.spans.begin(), recording.spans.end(), is_commanded)) {
    return std::nullopt;
  }
  MotionRecording result = recording;
  for (MotionStreams& streams : result.spans) {
    if (streams.commanded) {
      streams.currents = streams.commanded->currents;
      streams.response = atLeastUncertain(streams.commanded->response, streams);
      streams.commanded.reset();
    }
  }
  return result;
}

MotionEstimate estimateByBetterCurrents(const std::optional<MotionRecording>& commanded,
                                        const EstimationOptions& options,
                                        MotionProblem& problem) {
  MotionEstimate found = estimateMotion(problem, options, MotionOptions());
  if (!commanded) {
    return found;
  }
  const MotionRecording* const sampled = std::exchange(problem.recording, &*commanded);
  MotionEstimate other = estimateMotion(problem, options, MotionOptions());
  if (fitsAsWell(other, found)) {
    return other;
  }
  problem.recording = sampled;
  return found;
}

}  // namespace sac
