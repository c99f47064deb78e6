#include "spherical_actuator_calibration/motion/motion_memory.hpp"

#include <limits>
#include <utility>

namespace sac {
namespace {

/// Of a stretch: both its ends lose a window [s].
constexpr double kStretch = 30.0;

constexpr std::size_t kJointBytes = sizeof(Eigen::Vector3d) + sizeof(Stamp);
constexpr std::size_t kOrientationBytes = sizeof(Eigen::Quaterniond) + sizeof(Stamp);

std::size_t currentBytes(std::size_t coils) {
  return coils * sizeof(float) + sizeof(Stamp);
}

std::size_t bytesOf(const MotionStreams& streams) {
  const std::size_t currents = streams.current_stamps.size() *
                               currentBytes(static_cast<std::size_t>(streams.currents.cols()));
  return streams.joints.size() * kJointBytes + streams.orientations.size() * kOrientationBytes +
         (streams.commanded ? 2 : 1) * currents;
}

/// Whether windows can be cut of it: dwells, and a fixture that turns a rotor without currents, are
/// of no use here.
bool isOfUse(const MotionStreams& streams) {
  constexpr double kLeastTime = 1.0;  // [s]
  return timesOf(streams).driven_motion >= kLeastTime;
}

}  // namespace

MotionMemory::MotionMemory(std::size_t coils, std::size_t most_bytes)
    : coils_(coils), most_bytes_(most_bytes), recorder_(coils) {}

void MotionMemory::add(const JointMeasurement& measurement) {
  const double age = begin_ ? secondsBetween(*begin_, measurement.stamp) : 0.0;
  // A clock that was set back, or a recording that is played once more, begins another one.
  if (age > kStretch || age < 0.0) {
    endStretch();
  }
  begin_ = begin_ ? begin_ : measurement.stamp;
  take(kJointBytes);
  recorder_.add(measurement);
}

void MotionMemory::add(const CurrentMeasurement& measurement) {
  take(currentBytes(coils_));
  recorder_.add(measurement);
}

void MotionMemory::add(const OrientationMeasurement& measurement) {
  take(kOrientationBytes);
  recorder_.add(measurement);
}

void MotionMemory::add(const CurrentCommand& command) {
  take(currentBytes(coils_));
  recorder_.add(command);
}

// Windows overlap; what they share counts once. One that is earlier than the last is of another
// clock.
void MotionMemory::restore(const std::vector<MotionSlice>& windows) {
  constexpr Stamp kNone = std::numeric_limits<Stamp>::min();
  Stamp joint = kNone;
  Stamp current = kNone;
  Stamp orientation = kNone;
  Stamp begin = kNone;
  for (const MotionSlice& window : windows) {
    const MotionStreams& streams = window.streams;
    if (streams.joint_stamps.front() < begin) {
      joint = current = orientation = kNone;
    }
    begin = streams.joint_stamps.front();
    std::size_t c = 0;
    std::size_t r = 0;
    for (std::size_t n = 0; n < streams.joints.size(); ++n) {
      const Stamp now = streams.joint_stamps[n];
      for (; c < streams.current_stamps.size() && streams.current_stamps[c] <= now; ++c) {
        if (streams.current_stamps[c] > current) {
          current = streams.current_stamps[c];
          const auto row = streams.currents.row(static_cast<Eigen::Index>(c));
          add(CurrentMeasurement{current, row.transpose().cast<double>()});
        }
      }
      for (; r < streams.orientations.size() && streams.orientation_stamps[r] <= now; ++r) {
        if (streams.orientation_stamps[r] > orientation) {
          orientation = streams.orientation_stamps[r];
          add(OrientationMeasurement{orientation, streams.orientations[r]});
        }
      }
      if (now > joint) {
        joint = now;
        add(JointMeasurement{joint, streams.joints[n]});
      }
    }
  }
}

/// One stream may flood while the joints are silent: no stretch becomes larger than half of all.
void MotionMemory::take(std::size_t bytes) {
  bytes_ += bytes;
  if (2 * bytes_ > most_bytes_) {
    endStretch();
  }
}

void MotionMemory::endStretch() {
  MotionRecording ended = recorder_.take();
  begin_.reset();
  bytes_ = 0;
  for (MotionStreams& streams : ended.spans) {
    if (isOfUse(streams)) {
      stretches_.push_back(std::move(streams));
    }
  }
  std::size_t bytes = 0;
  for (auto stretch = stretches_.rbegin(); stretch != stretches_.rend(); ++stretch) {
    bytes += bytesOf(*stretch);
    if (bytes > most_bytes_) {
      stretches_.erase(stretches_.begin(), stretch.base());
      return;
    }
  }
}

MotionRecording MotionMemory::recording() {
  endStretch();
  MotionRecording recording;
  recording.spans.assign(stretches_.begin(), stretches_.end());
  return recording;
}

void MotionMemory::forget() {
  recorder_ = MotionRecorder(coils_);
  begin_.reset();
  bytes_ = 0;
  stretches_.clear();
}

}  // namespace sac
