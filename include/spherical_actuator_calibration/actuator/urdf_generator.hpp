#pragma once

#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"

namespace sac {

/// Name of the joint between stator and rotor where the description has no joints.
inline constexpr const char* kFloatingJoint = "rotor_joint";

/// Text of the robot description (URDF) of an actuator: the links stator, joint_1, joint_2 and
/// rotor (`frame_prefix` before each name), between them the three joints of the description, by
/// their names. A rotor without joints hangs on the stator by a floating joint, kFloatingJoint, and
/// has no shaft. Visuals "pole_1", "pole_2"… are magnets on the rotor, cylinders along the pole
/// axes, red for polarity 1 and blue for −1; "coil_1"… are cylinders along the coil axes on the
/// stator. The inertia of the rotor is rotorMass(); stator, joints and shaft have none.
///
/// Axes and offsets of the joints are exact to the last digit, so that renderCalibratedUrdf() takes
/// the text as the template of this actuator; poses and sizes are rounded to nanometres and
/// nanoradians. Throws ConfigError, as validate(), for what cannot be an actuator.
std::string renderUrdf(const Actuator& actuator,
                       const ActuatorDimensions& dimensions,
                       const std::string& frame_prefix = "");

}  // namespace sac
