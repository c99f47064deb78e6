#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/stamp_interval.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"
#include "spherical_actuator_calibration/streams/sliding_extremes.hpp"

namespace sac {

/// Finds the spans in which the joint sensors stand still: every window of `rest_window` seconds in
/// the span holds each joint within `largest_joint_spread`. Single glitches are taken out first by
/// a median of three measurements. Amortised constant time per measurement.
class DwellDetector {
 public:
  explicit DwellDetector(const SampleBuilderOptions& options);

  /// Next joint measurement [rad]; stamps increase strictly. Returns the dwell that it ended, if
  /// any: by motion, by a hole longer than `largest_gap`, or by its length.
  std::optional<StampInterval> add(Stamp stamp, const Eigen::Vector3d& position);

  /// Ends the dwell, if any, and forgets everything before.
  std::optional<StampInterval> close();

  /// No dwell that is reported from now on begins before this stamp. Nothing before the first
  /// measurement.
  std::optional<Stamp> earliestBegin() const;

  /// The dwell that has not ended yet, up to the newest measurement known to belong to it.
  const std::optional<StampInterval>& present() const { return dwell_; }

  /// Stamp of the newest measurement.
  std::optional<Stamp> newest() const;

 private:
  struct Reading {
    Stamp stamp = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
  };

  std::optional<StampInterval> addFiltered(Stamp stamp, const Eigen::Vector3d& position);
  std::optional<StampInterval> endDwell();
  bool windowAtRest(Stamp stamp) const;

  Stamp window_;
  Stamp largest_gap_;
  Stamp largest_dwell_;
  double largest_spread_;

  std::array<Reading, 2> recent_;  ///< the last two measurements, older first
  std::size_t recent_count_ = 0;
  std::optional<Stamp> window_begin_;  ///< oldest measurement since the window was restarted
  std::array<SlidingExtremes, 3> extremes_;
  std::optional<StampInterval> dwell_;
};

}  // namespace sac
