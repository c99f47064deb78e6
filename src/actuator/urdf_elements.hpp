#pragma once

#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace tinyxml2 {
class XMLElement;
}

namespace sac {

/// Three numbers with all digits of a double, as URDF attributes have them; never "-0".
std::string exactTriple(const Eigen::Vector3d& v);

/// Puts axis and offset into the element of a joint: the axis is ω, the rotation of its origin
/// e^{ω̂ δq}. Read back, both are exact to 1e-12; the position of the origin stays.
void writeJointAxis(tinyxml2::XMLElement& element, const JointAxis& joint);

}  // namespace sac
