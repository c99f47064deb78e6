#include "spherical_actuator_calibration/streams/sample_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "current_segments.hpp"
#include "dwell_samples.hpp"
#include "repeated_samples.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

/// A stream that is silent for longer was switched off on purpose: a tracker that is only needed
/// for some poses [s].
constexpr double kSwitchedOff = 30.0;

/// By which a recorder may get one stream after another [s].
constexpr double kRecorderLag = 10.0;

std::optional<DropReason> defectOf(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return values.allFinite() ? std::nullopt : std::optional(DropReason::kNotFinite);
}

std::optional<DropReason> defectOf(const Eigen::Quaterniond& q) {
  if (!q.coeffs().allFinite()) {
    return DropReason::kNotFinite;
  }
  return isUnit(q) ? std::nullopt : std::optional(DropReason::kNotUnit);
}

const SampleBuilderOptions& validated(const SampleBuilderOptions& options) {
  validate(options);
  return options;
}

StampFilterOptions stampOptions(const SampleBuilderOptions& options) {
  return {options.largest_gap, options.clock_reset, options.largest_jump};
}

}  // namespace

SampleBuilder::SampleBuilder(const SampleBuilderOptions& options,
                             std::size_t coils,
                             bool has_joints)
    : options_(restOptions(validated(options), has_joints)),
      coils_(coils),
      largest_gap_(ticksFromSeconds(options.largest_gap)),
      stream_timeout_(ticksFromSeconds(options.stream_timeout)),
      buffers_(coils),
      joints_{&report_.joints, &buffers_.joints, StampFilter(stampOptions(options)), std::nullopt},
      orientations_{
          &report_.orientations, &buffers_.orientations, StampFilter(stampOptions(options)), {}},
      torques_{&report_.torques, &buffers_.torques, StampFilter(stampOptions(options)), {}},
      currents_{&report_.currents, &buffers_.currents, StampFilter(stampOptions(options)), {}},
      detector_(options_) {
  buffers_.has_joints = has_joints;
}

SampleBuilder::~SampleBuilder() = default;

void SampleBuilder::repeat(const std::vector<Sample>& taken) {
  repeated_ = taken.empty() ? nullptr : std::make_unique<RepeatedSamples>(taken, options_);
}

void SampleBuilder::add(const JointMeasurement& measurement) {
  if (!buffers_.has_joints || !accept(joints_, measurement.stamp, defectOf(measurement.position))) {
    return;
  }
  for (std::size_t k = 0; k < joint_steps_.size(); ++k) {
    const auto joint = static_cast<Eigen::Index>(k);
    joint_steps_[k].add(measurement.position[joint]);
    buffers_.joint_step[joint] = joint_steps_[k].step();
  }
  queue(detector_.add(measurement.stamp, measurement.position));
  store(joints_, measurement.stamp, measurement.position.data());
}

void SampleBuilder::add(const OrientationMeasurement& measurement) {
  if (!accept(orientations_, measurement.stamp, defectOf(measurement.q_stator_rotor))) {
    return;
  }
  const Eigen::Vector4d xyzw = measurement.q_stator_rotor.coeffs().normalized();
  if (!buffers_.has_joints) {
    followOrientation(measurement.stamp, Eigen::Quaterniond(xyzw));
  }
  store(orientations_, measurement.stamp, xyzw.data());
}

/// Takes the orientation of a rotor without joints as what tells its rest.
void SampleBuilder::followOrientation(Stamp stamp, const Eigen::Quaterniond& q_stator_rotor) {
  turned_ += rotationLog((q_stator_rotor * tracked_.conjugate()).toRotationMatrix());
  tracked_ = q_stator_rotor;
  queue(detector_.add(stamp, turned_));
  buffers_.joints.push(stamp, turned_.data());
}

void SampleBuilder::add(const TorqueMeasurement& measurement) {
  if (accept(torques_, measurement.stamp, defectOf(measurement.torque))) {
    store(torques_, measurement.stamp, measurement.torque.data());
  }
}

void SampleBuilder::add(const CurrentMeasurement& measurement) {
  if (coils_ == 0) {
    return;
  }
  const bool right_size = static_cast<std::size_t>(measurement.current.size()) == coils_;
  const auto defect =
      right_size ? defectOf(measurement.current) : std::optional(DropReason::kWrongSize);
  if (accept(currents_, measurement.stamp, defect)) {
    store(currents_, measurement.stamp, measurement.current.data());
  }
}

void SampleBuilder::finish() {
  endTimeBase();
  if (repeated_) {
    takeRepeated(std::numeric_limits<Stamp>::max(), std::nullopt);
    repeated_.reset();
  }
  for (Stream* stream : {&joints_, &orientations_, &torques_, &currents_}) {
    stream->filter.restart();
  }
}

CaptureProgress SampleBuilder::capture(Stamp from, double duration) const {
  using State = CaptureProgress::State;
  if (!(duration >= options_.smallest_duration && duration <= options_.longestCapture())) {
    return {State::kRefused,
            std::nullopt,
            "The duration must lie between " + shortNumber(options_.smallest_duration) + " and " +
                shortNumber(options_.longestCapture()) + " s."};
  }
  const std::string silent = silentStream();
  if (!silent.empty()) {
    return {State::kRefused, std::nullopt, silent};
  }
  if (*newest_ < from - stream_timeout_) {
    return {State::kRefused, std::nullopt, "The clock of the measurements was set back."};
  }
  const bool too_late = newest_ && secondsBetween(from, *newest_) >
                                       duration + kPatience + options_.guard_before_motion;
  const State unfinished = too_late ? State::kRefused : State::kWaiting;
  const std::optional<StampInterval> dwell = presentInTime();
  if (!dwell) {
    return {unfinished, std::nullopt, "The rotor moves: let it rest."};
  }
  const Stamp begin = std::max(from, settledSince(*dwell));
  const StampInterval span{begin, begin + ticksFromSeconds(duration)};
  const Stamp limit = span.end + ticksFromSeconds(options_.guard_before_motion);
  if (dwell->end < limit || !allPassed(limit)) {
    const bool came_too_late = newest_behind_ && *newest_behind_ >= from;
    return {unfinished,
            std::nullopt,
            came_too_late
                ? "Measurements came too late to be used: a computer is too busy."
                : "Rotor and currents were not steady for " + shortNumber(duration) + " s."};
  }
  return captured(*dwell, span);
}

std::vector<Sample> SampleBuilder::takeSamples() {
  return std::exchange(samples_, {});
}

// A stream that was there and is silent now; without it the sample would lack a quantity by
// accident.
std::string SampleBuilder::silentStream() const {
  if (!readings().horizon) {
    return buffers_.has_joints ? "No joint measurement has come: is joint_states published?"
                               : "No orientation has come: is measured_orientation published?";
  }
  const std::array<std::pair<const Stream*, const char*>, 4> streams = {{
      {&joints_, "joint_states"},
      {&orientations_, "measured_orientation"},
      {&torques_, "measured_torque"},
      {&currents_, "coil_currents"},
  }};
  for (const auto& [stream, name] : streams) {
    if (!stream->horizon) {
      continue;
    }
    const double silence = secondsBetween(*stream->horizon, *newest_);
    if (silence > options_.largest_gap && (stream == &readings() || silence < kSwitchedOff)) {
      return std::string("The stream ") + name + " is silent for " + shortNumber(silence) +
             " s: check its node (one that is switched off on purpose counts as absent after " +
             shortNumber(kSwitchedOff) + " s).";
    }
  }
  return {};
}

// The present dwell. What came too late is missing here but not in a recording: the dwell counts
// from after it.
std::optional<StampInterval> SampleBuilder::presentInTime() const {
  std::optional<StampInterval> dwell = detector_.present();
  if (dwell && newest_behind_ && *newest_behind_ >= dwell->begin) {
    dwell->begin = *newest_behind_ + 1;
  }
  return dwell;
}

Stamp SampleBuilder::settledSince(const StampInterval& dwell) const {
  const Stamp rest = dwell.begin + ticksFromSeconds(options_.settle_after_motion);
  const std::vector<CurrentSegment> segments =
      segmentsOfConstantCurrent(buffers_.currents, {dwell.begin, *newest_}, options_);
  if (segments.empty()) {
    return rest;
  }
  return std::max(
      rest, segments.back().span.begin + ticksFromSeconds(options_.settle_after_current_change));
}

bool SampleBuilder::allPassed(Stamp stamp) const {
  const auto has_passed = [&](const Stream& stream) {
    return !stream.horizon || *stream.horizon >= stamp ||
           secondsBetween(*stream.horizon, *newest_) > kSwitchedOff;
  };
  return has_passed(joints_) && has_passed(orientations_) && has_passed(torques_) &&
         has_passed(currents_);
}

// What came after the guard is not looked at, though it may be there: how much of it is there is a
// matter of chance.
CaptureProgress SampleBuilder::captured(const StampInterval& dwell,
                                        const StampInterval& span) const {
  SampleBuilderReport report;
  CaptureProgress progress;
  const StampInterval rest{dwell.begin, span.end + ticksFromSeconds(options_.guard_before_motion)};
  progress.sample = sampleOfSpan(buffers_, rest, span, options_, report);
  progress.state =
      progress.sample ? CaptureProgress::State::kDone : CaptureProgress::State::kRefused;
  for (const DwellEvent& event : report.events) {
    progress.message += (progress.message.empty() ? "" : " ") + event.reason;
  }
  return progress;
}

bool SampleBuilder::accept(Stream& stream, Stamp stamp, std::optional<DropReason> defect) {
  ++stream.statistics->received;
  StampFilter::Verdict verdict;
  if (!defect) {
    verdict = stream.filter.judge(stamp);
    defect = verdict.drop;
  }
  if (verdict.clock_reset) {
    ++stream.statistics->clock_resets;
    endTimeBase();
  }
  if (verdict.gap) {
    ++stream.statistics->gaps;
  }
  if (!defect && newest_ && *newest_ - stamp > largestLag()) {
    defect = DropReason::kBehind;
    newest_behind_ = std::max(newest_behind_.value_or(stamp), stamp);
  }
  if (defect) {
    ++stream.statistics->dropped[static_cast<std::size_t>(*defect)];
    return false;
  }
  ++stream.statistics->accepted;
  stream.horizon = stamp;
  newest_ = std::max(newest_.value_or(stamp), stamp);
  return true;
}

// What was taken live was there in time. How late it came to a recorder does not matter.
Stamp SampleBuilder::largestLag() const {
  return repeated_ ? std::max(stream_timeout_, ticksFromSeconds(kRecorderLag)) : stream_timeout_;
}

void SampleBuilder::store(Stream& stream, Stamp stamp, const double* values) {
  stream.buffer->push(stamp, values);
  closeDwellOfSilentJoints();
  evaluateReadyDwells();
  stream.buffer->dropBefore(oldestNeeded());
  if (!buffers_.has_joints && &stream == &orientations_) {
    buffers_.joints.dropBefore(oldestNeeded());
  }
}

// Whatever follows belongs to another time: no stamp before can be compared with it.
void SampleBuilder::endTimeBase() {
  queue(detector_.close());
  while (!queued_.empty()) {
    evaluateFront();
  }
  if (repeated_ && newest_) {
    takeRepeated(*newest_, std::nullopt);
  }
  newest_.reset();
  newest_behind_.reset();
  for (Stream* stream : {&joints_, &orientations_, &torques_, &currents_}) {
    stream->buffer->clear();
    stream->horizon.reset();
  }
}

void SampleBuilder::queue(const std::optional<StampInterval>& dwell) {
  if (dwell) {
    queued_.push_back(*dwell);
  }
}

// The next joint measurement that can be accepted would lie behind a hole and end the dwell: the
// same dwell, without waiting for it.
void SampleBuilder::closeDwellOfSilentJoints() {
  const std::optional<Stamp> newest_joint = detector_.newest();
  if (newest_joint && *newest_ - *newest_joint > stream_timeout_ + largest_gap_) {
    queue(detector_.close());
  }
}

void SampleBuilder::evaluateReadyDwells() {
  while (!queued_.empty() && isReady(queued_.front())) {
    evaluateFront();
  }
  // Where no rest is seen nothing else ends their waiting, and what they need must not pile up.
  if (repeated_ && queued_.empty()) {
    takeRepeated(*newest_ - stream_timeout_ - ticksFromSeconds(options_.largest_dwell),
                 std::nullopt);
  }
}

// Ready when no measurement of the dwell can be accepted any more, whatever arrives: then the
// samples cannot depend on the order of arrival.
bool SampleBuilder::isReady(const StampInterval& dwell) const {
  if (*newest_ - dwell.end > stream_timeout_) {
    return true;
  }
  const auto has_passed = [&dwell](const Stream& stream) {
    return stream.horizon && *stream.horizon >= dwell.end;
  };
  return has_passed(readings()) && has_passed(orientations_) && has_passed(torques_) &&
         (coils_ == 0 || has_passed(currents_));
}

void SampleBuilder::evaluateFront() {
  ++report_.dwells;
  const StampInterval dwell = queued_.front();
  if (repeated_) {
    takeRepeated(dwell.end, dwell);
  } else {
    for (Sample& sample : samplesOfDwell(buffers_, dwell, options_, report_)) {
      sample.id = next_id_++;
      samples_.push_back(std::move(sample));
    }
  }
  queued_.pop_front();
}

void SampleBuilder::takeRepeated(Stamp until, const std::optional<StampInterval>& dwell) {
  for (Sample& sample : repeated_->upTo(until, dwell, buffers_, report_)) {
    samples_.push_back(std::move(sample));
  }
}

Stamp SampleBuilder::oldestNeeded() const {
  const Stamp oldest = !queued_.empty()
                           ? queued_.front().begin
                           : detector_.earliestBegin().value_or(*newest_ - stream_timeout_);
  const bool is_repeating = repeated_ && !repeated_->empty();
  return is_repeating ? std::min(oldest, repeated_->oldestNeeded()) : oldest;
}

}  // namespace sac
