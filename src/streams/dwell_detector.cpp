#include "spherical_actuator_calibration/streams/dwell_detector.hpp"

#include <algorithm>
#include <utility>

namespace sac {
namespace {

Eigen::Vector3d medianOfThree(const Eigen::Vector3d& a,
                              const Eigen::Vector3d& b,
                              const Eigen::Vector3d& c) {
  return a.cwiseMin(b).cwiseMax(a.cwiseMax(b).cwiseMin(c));
}

}  // namespace

DwellDetector::DwellDetector(const SampleBuilderOptions& options)
    : window_(ticksFromSeconds(options.rest_window)),
      largest_gap_(ticksFromSeconds(options.largest_gap)),
      largest_dwell_(ticksFromSeconds(options.largest_dwell)),
      largest_spread_(options.largest_joint_spread) {}

std::optional<StampInterval> DwellDetector::add(Stamp stamp, const Eigen::Vector3d& position) {
  std::optional<StampInterval> ended;
  if (recent_count_ > 0 && stamp - *newest() > largest_gap_) {
    ended = close();
  }
  if (recent_count_ < 2) {
    recent_[recent_count_++] = {stamp, position};
    return ended;
  }
  ended = addFiltered(recent_[1].stamp,
                      medianOfThree(recent_[0].position, recent_[1].position, position));
  recent_[0] = recent_[1];
  recent_[1] = {stamp, position};
  return ended;
}

std::optional<StampInterval> DwellDetector::close() {
  recent_count_ = 0;
  return endDwell();
}

std::optional<Stamp> DwellDetector::earliestBegin() const {
  if (dwell_) {
    return dwell_->begin;
  }
  if (recent_count_ == 0) {
    return std::nullopt;
  }
  // recent_[0] is the newest reading that was evaluated, or the first that will be needed.
  return window_begin_ ? std::max(*window_begin_, recent_[0].stamp - window_) : recent_[0].stamp;
}

std::optional<Stamp> DwellDetector::newest() const {
  if (recent_count_ == 0) {
    return std::nullopt;
  }
  return recent_[recent_count_ - 1].stamp;
}

std::optional<StampInterval> DwellDetector::addFiltered(Stamp stamp,
                                                        const Eigen::Vector3d& position) {
  if (!window_begin_) {
    window_begin_ = stamp;
  }
  for (std::size_t k = 0; k < extremes_.size(); ++k) {
    extremes_[k].dropBefore(stamp - window_);
    extremes_[k].add(stamp, position[static_cast<Eigen::Index>(k)]);
  }
  if (!windowAtRest(stamp)) {
    // Only a window that lies wholly behind the dwell may begin another, lest the two overlap.
    return dwell_ ? endDwell() : std::nullopt;
  }
  if (!dwell_) {
    dwell_ = StampInterval{std::max(*window_begin_, stamp - window_), stamp};
  }
  dwell_->end = stamp;
  return dwell_->end - dwell_->begin >= largest_dwell_ ? endDwell() : std::nullopt;
}

std::optional<StampInterval> DwellDetector::endDwell() {
  window_begin_.reset();
  for (SlidingExtremes& extremes : extremes_) {
    extremes.clear();
  }
  return std::exchange(dwell_, std::nullopt);
}

bool DwellDetector::windowAtRest(Stamp stamp) const {
  return stamp - *window_begin_ >= window_ &&
         std::all_of(extremes_.begin(), extremes_.end(), [this](const SlidingExtremes& extremes) {
           return extremes.spread() <= largest_spread_;
         });
}

}  // namespace sac
