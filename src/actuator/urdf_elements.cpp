#include "urdf_elements.hpp"

#include <cmath>
#include <limits>

#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

#include <tinyxml2.h>

namespace sac {
namespace {

/// Roll, pitch, yaw [rad] of R = R_z(yaw) R_y(pitch) R_x(roll), as URDF has it. The roll is taken
/// relative to the yaw, so that the product stays exact where both turn about the same axis.
Eigen::Vector3d rollPitchYaw(const Eigen::Matrix3d& R) {
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const double s = std::sin(yaw);
  const double c = std::cos(yaw);
  const double pitch = std::atan2(-R(2, 0), c * R(0, 0) + s * R(1, 0));
  const double roll = std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1));
  return {roll, pitch, yaw};
}

tinyxml2::XMLElement& childElement(tinyxml2::XMLElement& parent, const char* name) {
  tinyxml2::XMLElement* child = parent.FirstChildElement(name);
  return child != nullptr ? *child : *parent.InsertNewChildElement(name);
}

}  // namespace

std::string exactTriple(const Eigen::Vector3d& v) {
  std::string text;
  for (const double value : v) {
    constexpr int kExact = std::numeric_limits<double>::max_digits10;
    text += (text.empty() ? "" : " ") + roundedText(value + 0.0, kExact);
  }
  return text;
}

void writeJointAxis(tinyxml2::XMLElement& element, const JointAxis& joint) {
  const Eigen::Vector3d axis = joint.axis.normalized();
  childElement(element, "axis").SetAttribute("xyz", exactTriple(axis).c_str());
  childElement(element, "origin")
      .SetAttribute("rpy", exactTriple(rollPitchYaw(rotationExp(axis * joint.offset))).c_str());
}

}  // namespace sac
