#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/motion/motion_streams.hpp"
#include "stamp_times.hpp"

namespace sac {

/// Of so many readings a TrackPoint may be made.
constexpr std::size_t kMostShares = 9;

/// Joint angles at a time between readings.
struct TrackPoint {
  Eigen::Vector3d position;                 ///< [rad]
  Eigen::Vector3d velocity;                 ///< [rad/s]
  std::size_t first = 0;                    ///< of the readings that it is made of
  std::size_t count = 0;                    ///< of these
  std::array<double, kMostShares> share{};  ///< of each in `position`
};

/// The readings of one span as a smooth motion: cubic through the nearest four readings.
class JointTrack {
 public:
  /// Keeps a reference. Times count in seconds from `origin`.
  JointTrack(const MotionStreams& streams, Stamp origin);

  std::size_t size() const { return times_.size(); }
  double time(std::size_t n) const { return times_[n]; }
  const Eigen::Vector3d& reading(std::size_t n) const { return streams_->joints[n]; }
  /// The first reading that is not before a time, or size().
  std::size_t firstFrom(double time) const { return times_.firstFrom(time); }
  /// Usual step between readings [s].
  double step() const { return step_; }
  /// Readings on either side of one over which a rate is hardly noise: some 10 ms, and where that
  /// is less than a step none.
  std::size_t rateReach() const;
  /// Whether no reading is missing between n and n + 1.
  bool isWhole(std::size_t n) const { return times_[n + 1] - times_[n] <= longest_; }

  /// Nothing where readings are missing.
  std::optional<TrackPoint> at(double time) const;
  /// The same by the cubic that is nearest to all readings of so long a time [s], at most
  /// kMostShares: with less noise than one reading has.
  std::optional<TrackPoint> smoothAt(double time, double length) const;

 private:
  static constexpr std::size_t kStencil = 4;  ///< readings that a cubic goes through

  /// `count` readings around a time; nothing where some are missing.
  std::optional<TrackPoint> begun(double time, std::size_t count) const;

  const MotionStreams* streams_;
  StampTimes times_;
  double step_ = 0.0;
  double longest_ = 0.0;  ///< interval in which no reading is missing [s]
};

/// Longest interval [s] between messages with the usual `step` [s] that no hole is in: of so many
/// `steps`, or as short as the intervals of a stream at 200 Hz, which serves as it is.
double longestWhole(double step, double steps);

/// Median step of increasing times, by some of them where there are many; 0 for fewer than two.
double usualStep(const std::vector<double>& times);
double usualStep(const StampTimes& times);

/// Seconds from `origin`.
std::vector<double> secondsFrom(Stamp origin, const LongSeries<Stamp>& stamps);

}  // namespace sac
