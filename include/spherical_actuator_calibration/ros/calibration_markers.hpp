#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <visualization_msgs/MarkerArray.h>

#include "spherical_actuator_calibration/core/actuator.hpp"

namespace spherical_actuator_calibration {

/// What the live view shows of a calibration.
struct CalibrationScene {
  Actuator nominal;
  Actuator identified;       ///< parameters in force; as many poles and coils as `nominal`
  Eigen::VectorXd currents;  ///< of the coils [A]; empty: not known
  /// Directions of the rotor's z axis in the stator frame, one for each sample.
  std::vector<Eigen::Vector3d> sampled_directions;
  double magnification = 10.0;  ///< of the difference between identified and nominal axes, ≥ 1
  std::string stator_frame = "stator";
  std::string rotor_frame = "rotor";
};

/// Markers of a scene: poles as arrows in the rotor frame, red for polarity 1 and blue for −1,
/// coils as arrows in the stator frame that glow with their current, the nominal axes of both as
/// thin grey arrows, and a dot on a sphere for each sample. The same ids for the same things, so
/// that a new array takes the place of the one before.
visualization_msgs::MarkerArray calibrationMarkers(const CalibrationScene& scene);

}  // namespace spherical_actuator_calibration
