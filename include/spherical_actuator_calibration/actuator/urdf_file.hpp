#pragma once

#include <array>
#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"

namespace sac {

/// Names of the three joints, in the order of the product of exponentials.
using JointNames = std::array<std::string, kJoints>;

/// Reads the three joints of a robot description (URDF). A joint stands for e^{ω̂(q + δq)}: its axis
/// is ω, the rotation of its origin is e^{ω̂ δq}, with δq in [-π, π] rad.
///
/// Throws ConfigError that names file and joint when the file cannot be read as URDF, a joint is
/// missing or neither revolute nor continuous, the joints do not form a chain in this order (the
/// child link of one is the parent link of the next), or an origin turns about another axis than
/// its joint (by more than 1e-6 rad).
std::array<JointAxis, kJoints> readJoints(const std::string& path, const JointNames& names);

/// Copies a robot description and puts the axes and offsets of `calibrated` into its three joints;
/// positions of their origins and everything else (unknown elements, attributes, comments, their
/// order) stay. Read back, axes and offsets are exact to 1e-12. Of a rotor without joints nothing
/// that was identified is in a robot description: the template, which must have a floating joint,
/// stays as it is.
///
/// Throws ConfigError as readJoints(), and when the joints of the template differ from `nominal` by
/// more than 1e-6 rad: it describes another actuator then, or is calibrated already. Throws
/// DataError as writeFileAtomically().
void writeCalibratedUrdf(const std::string& template_path,
                         const std::string& output_path,
                         const Actuator& nominal,
                         const Actuator& calibrated,
                         OverwritePolicy policy);

/// The same from text to text; `name` stands for the template in messages.
std::string renderCalibratedUrdf(const std::string& template_text,
                                 const std::string& name,
                                 const Actuator& nominal,
                                 const Actuator& calibrated);

}  // namespace sac
