#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <visualization_msgs/MarkerArray.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"

namespace sac {

/// Frames that the markers are drawn in.
struct SceneFrames {
  std::string stator = "stator";
  std::string rotor = "rotor";                  ///< by the parameters in force
  std::string nominal_rotor = "rotor_nominal";  ///< by the nominal ones
  std::string joint_1 = "joint_1";              ///< after the first joint, before the second
  std::string joint_2 = "joint_2";              ///< after the second, before the third
};

/// A sample as a dot: where the rotor's z axis pointed, and how well it fits.
struct SampledDirection {
  Eigen::Vector3d direction_stator = Eigen::Vector3d::UnitZ();  ///< unit, stator frame
  std::optional<double> standardized;  ///< residual in units of its expected size, about 1 if good
  bool rejected = false;
};

/// What the live view shows of a calibration.
struct CalibrationScene {
  Actuator nominal;
  Actuator identified;  ///< parameters in force; as many poles and coils as `nominal`
  ActuatorDimensions dimensions;
  /// Standard deviation [rad] of each axis where it is identified; empty lists: of none.
  std::vector<std::optional<double>> pole_stddevs;
  std::vector<std::optional<double>> coil_stddevs;
  Eigen::VectorXd currents;  ///< of the coils [A]; empty: not known
  std::vector<SampledDirection> samples;
  /// Raw joint angles [rad] of the pose that somebody is asked to go to.
  std::optional<Eigen::Vector3d> wanted_joint_position;
  double magnification = 10.0;  ///< of errors and standard deviations of the axes, ≥ 1
  SceneFrames frames;
};

/// Markers of a scene, always with the same ids for the same things, so that a new array takes the
/// place of the one before:
/// - "poles" (rotor frame; red for polarity 1, blue for −1) and "coils" (stator frame): arrows
/// along
///   the identified axes, their difference from nominal magnified; "nominal poles" and "nominal
///   coils": thin grey arrows as drawn;
/// - "pole uncertainty", "coil uncertainty": cones about the identified axes whose half angle is
/// the
///   magnified standard deviation;
/// - "joints", "joint ring": rods along the identified joint axes, magnified likewise, each in the
/// frame
///   that carries it, and the ring of a gimbal that the first one carries and that carries the
///   second; none where the rotor has no joints;
/// - "nominal rotor": a ghost of the rotor in its nominal frame;
/// - "wanted pose": another, green, where the rotor is to go (stator frame);
/// - "currents": coils that carry current glow;
/// - "samples": dots around the shaft's tip, green where residuals are as expected, red from three
///   times that on, black where rejected, grey before any cycle. One dot for all samples of an
///   orientation, of the worst of them.
visualization_msgs::MarkerArray calibrationMarkers(const CalibrationScene& scene);

}  // namespace sac
