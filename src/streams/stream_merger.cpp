#include "spherical_actuator_calibration/streams/stream_merger.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace sac {
namespace {

Stamp stampOf(const AnyMeasurement& measurement) {
  return std::visit([](const auto& any) { return any.stamp; }, measurement);
}

}  // namespace

StreamMerger::StreamMerger(double clock_reset) : clock_reset_(clock_reset) {}

void StreamMerger::add(AnyMeasurement measurement, double now) {
  advance(now);
  Stream& stream = streams_[measurement.index()];
  const Stamp stamp = stampOf(measurement);
  // An unstamped measurement tells nothing about its stream.
  if (stamp > 0) {
    if (stream.last_arrival && secondsBetween(stamp, stream.last_stamp) >= clock_reset_) {
      ++stream.round;
    }
    stream.last_stamp = stamp;
    stream.last_arrival = clock_;
  }
  stream.waiting.push_back({std::move(measurement), stamp, stream.round, clock_});
}

std::optional<AnyMeasurement> StreamMerger::next(double now) {
  advance(now);
  if (patienceIsOver()) {
    forgetRounds();
    return nextAtOnce();
  }
  return isComplete() ? nextAtOnce() : std::nullopt;
}

std::optional<AnyMeasurement> StreamMerger::nextAtOnce() {
  Stream* stream = first();
  if (stream == nullptr) {
    return std::nullopt;
  }
  std::optional<AnyMeasurement> measurement = std::move(stream->waiting.front().measurement);
  stream->waiting.pop_front();
  return measurement;
}

void StreamMerger::advance(double now) {
  clock_ += std::clamp(now - last_now_.value_or(now), 0.0, kLongestStep);
  last_now_ = now;
}

// Of the streams that have something, the one whose measurement comes first.
StreamMerger::Stream* StreamMerger::first() {
  Stream* first = nullptr;
  for (Stream& stream : streams_) {
    if (stream.waiting.empty()) {
      continue;
    }
    const Waiting& front = stream.waiting.front();
    if (first == nullptr ||
        std::tie(front.round, front.stamp) <
            std::tie(first->waiting.front().round, first->waiting.front().stamp)) {
      first = &stream;
    }
  }
  return first;
}

// Whether the oldest measurement of every stream is known.
bool StreamMerger::isComplete() const {
  return std::none_of(streams_.begin(), streams_.end(), [this](const Stream& stream) {
    return stream.waiting.empty() && stream.last_arrival &&
           clock_ - *stream.last_arrival <= kSilence;
  });
}

bool StreamMerger::patienceIsOver() const {
  return std::any_of(streams_.begin(), streams_.end(), [this](const Stream& stream) {
    return !stream.waiting.empty() && clock_ - stream.waiting.front().arrival > kPatience;
  });
}

// Not all streams were set back, or one missed it: their stamps alone tell the order again.
void StreamMerger::forgetRounds() {
  for (Stream& stream : streams_) {
    stream.round = 0;
    for (Waiting& waiting : stream.waiting) {
      waiting.round = 0;
    }
  }
}

}  // namespace sac
