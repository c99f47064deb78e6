#include "spherical_actuator_calibration/motion/motion_recording.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "command_response.hpp"
#include "joint_track.hpp"
#include "unwrapped_angle.hpp"

namespace sac {
namespace {

/// Seventeen minutes at a kilohertz: far more than is needed, and no more memory.
constexpr std::size_t kMostReadings = 1U << 20U;

/// Whether commands tell steps so well that nothing else needs to be tried: commands that come now
/// sooner, now later, or that samples follow too seldom, may tell less than samples alone.
bool tellsSteps(const CommandResponse& response, const MotionStreams& streams) {
  constexpr double kSure = 0.02;  // of the time between two samples
  const StampTimes times(streams.current_stamps.front(), streams.current_stamps);
  return response.lateness_stddev < kSure * usualStep(times);
}

/// Puts what commands tell of the currents into the streams.
void heed(const CommandStream& commands, MotionStreams& streams) {
  if (commands.stamps.empty()) {
    return;
  }
  StreamCurrents sampled = streams.currents;
  streams.response = takeMeans(commands, streams);
  if (!streams.response || tellsSteps(*streams.response, streams)) {
    return;
  }
  std::swap(sampled, streams.currents);
  streams.commanded =
      std::make_shared<CommandedCurrents>(CommandedCurrents{std::move(sampled), *streams.response});
  streams.response.reset();
}

}  // namespace

bool MotionRecorder::isSetBack(Sequence& sequence, Stamp last, Stamp stamp) {
  constexpr double kFar = 1.0;  // [s]
  if (secondsBetween(stamp, last) < kFar) {
    sequence.earlier.reset();
    return false;
  }
  const bool is_confirmed = sequence.earlier && stamp > *sequence.earlier &&
                            secondsBetween(*sequence.earlier, stamp) < kFar;
  sequence.earlier = stamp;
  return is_confirmed;
}

// As between two recordings: a driver that was started anew follows commands anew.
bool MotionRecorder::isAfterPause(Stamp stamp) const {
  constexpr double kPause = 5.0;  // [s]
  bool is_begun = false;
  for (const LongSeries<Stamp>* stamps :
       {&streams_.joint_stamps, &streams_.current_stamps, &streams_.orientation_stamps}) {
    if (!stamps->empty() && secondsBetween(stamps->back(), stamp) <= kPause) {
      return false;
    }
    is_begun = is_begun || !stamps->empty();
  }
  return is_begun;
}

bool MotionRecorder::isNext(Sequence& sequence,
                            const LongSeries<Stamp>& stamps,
                            Stamp stamp,
                            bool is_fine) {
  const bool is_set_back = is_fine && !stamps.empty() && isSetBack(sequence, stamps.back(), stamp);
  if (is_set_back || (is_fine && isAfterPause(stamp))) {
    endSpan();
  }
  const bool is_next =
      is_fine && (stamps.empty() || stamp > stamps.back()) && sequence.taken < kMostReadings;
  sequence.taken += is_next ? 1 : 0;
  recording_.dropped += is_next ? 0 : 1;
  return is_next;
}

void MotionRecorder::add(const JointMeasurement& measurement) {
  if (!isNext(
          joints_, streams_.joint_stamps, measurement.stamp, measurement.position.allFinite())) {
    return;
  }
  streams_.joint_stamps.push_back(measurement.stamp);
  streams_.joints.push_back(streams_.joints.empty()
                                ? measurement.position
                                : unwrapped(measurement.position, streams_.joints.back()));
}

bool MotionRecorder::isCurrent(const Eigen::VectorXd& current) const {
  return current.size() == static_cast<Eigen::Index>(coils_) && current.allFinite();
}

void MotionRecorder::add(const CurrentMeasurement& measurement) {
  if (!isNext(coil_currents_,
              streams_.current_stamps,
              measurement.stamp,
              isCurrent(measurement.current))) {
    return;
  }
  streams_.current_stamps.push_back(measurement.stamp);
  streams_.currents.addRow(measurement.current);
}

void MotionRecorder::add(const CurrentCommand& command) {
  LongSeries<Stamp>& stamps = commands_.stamps;
  const bool is_later = stamps.empty() || command.stamp > stamps.back();
  if (is_later && isCurrent(command.current) && stamps.size() < kMostReadings) {
    stamps.push_back(command.stamp);
    commands_.currents.addRow(command.current);
  }
}

void MotionRecorder::add(const OrientationMeasurement& measurement) {
  const double norm = measurement.q_stator_rotor.norm();
  const bool is_fine = std::isfinite(norm) && norm > 0.5;
  if (!isNext(orientations_, streams_.orientation_stamps, measurement.stamp, is_fine)) {
    return;
  }
  streams_.orientation_stamps.push_back(measurement.stamp);
  streams_.orientations.push_back(measurement.q_stator_rotor.normalized());
}

void MotionRecorder::endSpan() {
  if (!streams_.joints.empty() && !streams_.current_stamps.empty()) {
    heed(commands_, streams_);
    recording_.spans.push_back(std::move(streams_));
  }
  streams_ = MotionStreams();
  commands_ = CommandStream();
  for (Sequence* sequence : {&joints_, &orientations_, &coil_currents_}) {
    sequence->earlier.reset();
  }
}

void MotionRecorder::finish() {
  endSpan();
  for (Sequence* sequence : {&joints_, &orientations_, &coil_currents_}) {
    sequence->taken = 0;
  }
}

MotionRecording MotionRecorder::take() {
  finish();
  return std::exchange(recording_, MotionRecording());
}

MotionTimes timesOf(const MotionStreams& streams) {
  constexpr double kSpan = 0.1;    // [s] over which a rotor turns or rests
  constexpr double kMoved = 0.01;  // [rad] in that time
  MotionTimes times;
  std::size_t begin = 0;
  std::size_t current = 0;
  for (std::size_t n = 1; n < streams.joints.size(); ++n) {
    const double passed = secondsBetween(streams.joint_stamps[begin], streams.joint_stamps[n]);
    if (passed < kSpan) {
      continue;
    }
    bool is_driven = false;
    for (; current < streams.current_stamps.size() &&
           streams.current_stamps[current] < streams.joint_stamps[n];
         ++current) {
      const auto row = streams.currents.row(static_cast<Eigen::Index>(current));
      is_driven = is_driven || row.cwiseAbs().maxCoeff() > kExcitationThreshold;
    }
    const bool moves = (streams.joints[n] - streams.joints[begin]).norm() > kMoved;
    times.all += passed;
    times.motion += moves ? passed : 0.0;
    times.driven += is_driven ? passed : 0.0;
    times.driven_motion += moves && is_driven ? passed : 0.0;
    begin = n;
  }
  return times;
}

bool tellsMotion(const MotionRecording& recording) {
  MotionTimes sum;
  for (const MotionStreams& streams : recording.spans) {
    const MotionTimes times = timesOf(streams);
    sum.all += times.all;
    sum.motion += times.motion;
    sum.driven += times.driven;
  }
  return sum.all > 0.0 && 2.0 * sum.motion > sum.all && 2.0 * sum.driven > sum.all;
}

}  // namespace sac
