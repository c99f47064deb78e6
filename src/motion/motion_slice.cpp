#include "spherical_actuator_calibration/motion/motion_slice.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "motion_span.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "unwrapped_angle.hpp"

namespace sac {
namespace {

/// Beyond a window and the largest delay, until late streams have come [s].
constexpr double kWait = 0.1;

/// Longer than that without a reading: another motion [s].
constexpr double kHole = 0.5;

Stamp ticks(double seconds) {
  return static_cast<Stamp>(std::llround(seconds * 1e9));
}

/// Place of the first one not earlier than a stamp.
template <typename Stream>
std::size_t placeOf(const Stream& stream, Stamp stamp) {
  const auto place =
      std::lower_bound(stream.begin(), stream.end(), stamp, [](const auto& one, Stamp at) {
        return one.first < at;
      });
  return static_cast<std::size_t>(place - stream.begin());
}

/// A rotor that a hand or a fixture turns tells nothing here.
bool isDriven(const MotionStreams& streams) {
  for (Eigen::Index n = 0; n < streams.currents.rows(); ++n) {
    if (streams.currents.row(n).cwiseAbs().maxCoeff() > kExcitationThreshold) {
      return true;
    }
  }
  return false;
}

bool isIncreasing(const LongSeries<Stamp>& stamps) {
  return std::adjacent_find(stamps.begin(), stamps.end(), std::greater_equal<>()) == stamps.end();
}

bool areFinite(const StreamCurrents& currents) {
  for (Eigen::Index n = 0; n < currents.rows(); ++n) {
    if (!currents.row(n).allFinite()) {
      return false;
    }
  }
  return true;
}

bool isFine(const MotionStreams& streams, std::size_t coils) {
  const auto readings = static_cast<Eigen::Index>(streams.current_stamps.size());
  const auto is_unit = [](const Eigen::Quaterniond& orientation) {
    constexpr double kRounding = 1e-6;
    return std::abs(orientation.norm() - 1.0) < kRounding;
  };
  return isIncreasing(streams.joint_stamps) && isIncreasing(streams.current_stamps) &&
         isIncreasing(streams.orientation_stamps) &&
         streams.joints.size() == streams.joint_stamps.size() &&
         std::all_of(streams.joints.begin(),
                     streams.joints.end(),
                     [](const Eigen::Vector3d& position) { return position.allFinite(); }) &&
         streams.currents.rows() == readings && readings > 0 &&
         streams.currents.cols() == static_cast<Eigen::Index>(coils) &&
         areFinite(streams.currents) &&
         streams.orientations.size() == streams.orientation_stamps.size() &&
         std::all_of(streams.orientations.begin(), streams.orientations.end(), is_unit);
}

/// Why a window cannot serve; empty: it can.
std::string refusalOf(const MotionSlice& slice, const MotionOptions& options) {
  const MotionSpan span(slice.streams);
  if (span.current_times.empty()) {
    return "currents are missing";
  }
  std::string reason = refusalOf(span, {0, slice.window.first, slice.window.last}, options);
  return reason.empty() && !isDriven(slice.streams) ? "no coil is on" : reason;
}

template <typename Stream>
void dropFront(Stream& stream, std::size_t count) {
  stream.erase(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

void validate(const MotionSlice& slice, std::size_t coils, const MotionOptions& options) {
  const WindowRange& window = slice.window;
  const bool is_within = window.first >= kBeside && window.last >= window.first + kLeastReadings &&
                         window.last < slice.streams.joints.size() - kBeside;
  if (slice.streams.joints.size() <= kBeside || !is_within || !isFine(slice.streams, coils)) {
    throw DataError("A window of a motion holds none.");
  }
  const std::string reason = refusalOf(slice, options);
  if (!reason.empty()) {
    throw DataError("A window of a motion cannot serve: " + reason + ".");
  }
}

MotionSlicer::MotionSlicer(std::size_t coils, const MotionOptions& options)
    : coils_(coils), options_(options), begin_(kBeside) {}

template <typename Value>
void MotionSlicer::push(Stream<Value>& stream, Stamp stamp, const Value& value) {
  // Windows take less than a second of the fastest streams: more is a flood, or joints are silent.
  constexpr std::size_t kMost = 20000;
  if (stream.size() >= kMost) {
    forget();
  }
  if (stream.empty() || stamp > stream.back().first) {
    stream.emplace_back(stamp, value);
  }
}

void MotionSlicer::add(const JointMeasurement& measurement) {
  if (!measurement.position.allFinite()) {
    return;
  }
  Eigen::Vector3d position = measurement.position;
  if (!joints_.empty()) {
    const double step = secondsBetween(joints_.back().first, measurement.stamp);
    if (step > kHole || step < -kHole) {
      forget();
    } else {
      position = unwrapped(position, joints_.back().second);
    }
  }
  push(joints_, measurement.stamp, position);
}

void MotionSlicer::add(const CurrentMeasurement& measurement) {
  if (measurement.current.size() == static_cast<Eigen::Index>(coils_) &&
      measurement.current.allFinite()) {
    push(currents_, measurement.stamp, Eigen::VectorXf(measurement.current.cast<float>()));
  }
}

void MotionSlicer::add(const OrientationMeasurement& measurement) {
  const double norm = measurement.q_stator_rotor.norm();
  if (std::isfinite(norm) && norm > 0.5) {
    push(orientations_, measurement.stamp, measurement.q_stator_rotor.normalized());
  }
}

void MotionSlicer::forget() {
  joints_.clear();
  currents_.clear();
  orientations_.clear();
  begin_ = kBeside;
}

std::optional<std::size_t> MotionSlicer::end() const {
  if (begin_ >= joints_.size()) {
    return std::nullopt;
  }
  const Stamp stamp = joints_[begin_].first + ticks(options_.window);
  // Half a step of the readings is no reason to take one more.
  const Stamp step = joints_[begin_].first - joints_[begin_ - 1].first;
  const std::size_t end = std::max(placeOf(joints_, stamp - step / 2), begin_ + kLeastReadings);
  if (end + kBeside >= joints_.size() ||
      secondsBetween(joints_[end].first, joints_.back().first) < options_.largest_delay + kWait) {
    return std::nullopt;
  }
  return end;
}

MotionSlice MotionSlicer::cut(std::size_t end) const {
  const Stamp delay = ticks(options_.largest_delay);
  const Stamp from = joints_[begin_].first - delay;
  const Stamp to = joints_[end].first + delay;
  MotionSlice slice;
  MotionStreams& streams = slice.streams;
  const std::size_t earliest = std::min(placeOf(joints_, from), begin_ - kBeside);
  const std::size_t latest =
      std::min(std::max(placeOf(joints_, to), end + kBeside) + 1, joints_.size());
  for (std::size_t n = earliest; n < latest; ++n) {
    streams.joint_stamps.push_back(joints_[n].first);
    streams.joints.push_back(joints_[n].second);
  }
  slice.window = {begin_ - earliest, end - earliest};
  // One more on either side.
  const std::size_t first_current = placeOf(currents_, from);
  const std::size_t first_row = first_current - std::min<std::size_t>(first_current, 2);
  const std::size_t last_row = std::min(placeOf(currents_, to) + 2, currents_.size());
  for (std::size_t n = first_row; n < last_row; ++n) {
    streams.current_stamps.push_back(currents_[n].first);
    streams.currents.addRow(currents_[n].second);
  }
  for (std::size_t n = placeOf(orientations_, joints_[begin_].first);
       n < placeOf(orientations_, joints_[end].first);
       ++n) {
    streams.orientation_stamps.push_back(orientations_[n].first);
    streams.orientations.push_back(orientations_[n].second);
  }
  return slice;
}

void MotionSlicer::advance(std::size_t end) {
  const Stamp from = joints_[end].first - ticks(options_.largest_delay);
  const std::size_t readings = std::min(placeOf(joints_, from), end - kBeside);
  begin_ = end - readings;
  const Stamp next = joints_[end].first;
  dropFront(joints_, readings);
  const std::size_t currents = placeOf(currents_, from);
  dropFront(currents_, currents - std::min<std::size_t>(currents, 2));
  dropFront(orientations_, placeOf(orientations_, next));
}

std::optional<MotionSlice> MotionSlicer::take() {
  while (const std::optional<std::size_t> at = end()) {
    MotionSlice slice = cut(*at);
    advance(*at);
    const std::string reason = refusalOf(slice, options_);
    if (reason.empty()) {
      return slice;
    }
    countLeftOut(reason, left_out_);
  }
  return std::nullopt;
}

}  // namespace sac
