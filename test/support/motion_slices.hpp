#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/motion/motion_slice.hpp"
#include "spherical_actuator_calibration/motion/motion_streams.hpp"

namespace sac {

/// Calls `take` with all measurements in the order of their stamps.
template <typename Take>
void play(const MotionStreams& streams, const Take& take) {
  std::size_t current = 0;
  std::size_t orientation = 0;
  for (std::size_t n = 0; n < streams.joints.size(); ++n) {
    const Stamp now = streams.joint_stamps[n];
    for (; current < streams.current_stamps.size() && streams.current_stamps[current] <= now;
         ++current) {
      const auto row = streams.currents.row(static_cast<Eigen::Index>(current));
      take(CurrentMeasurement{streams.current_stamps[current],
                              Eigen::VectorXd(row.transpose().cast<double>())});
    }
    for (; orientation < streams.orientation_stamps.size() &&
           streams.orientation_stamps[orientation] <= now;
         ++orientation) {
      take(OrientationMeasurement{streams.orientation_stamps[orientation],
                                  streams.orientations[orientation]});
    }
    take(JointMeasurement{now, streams.joints[n]});
  }
}

/// All windows of a motion, as they come.
inline std::vector<MotionSlice> slicesOf(const MotionStreams& streams) {
  std::vector<MotionSlice> slices;
  MotionSlicer slicer(static_cast<std::size_t>(streams.currents.cols()), MotionOptions());
  play(streams, [&](const auto& measurement) {
    slicer.add(measurement);
    while (auto slice = slicer.take()) {
      slices.push_back(std::move(*slice));
    }
  });
  return slices;
}

}  // namespace sac
