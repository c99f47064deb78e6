#include "spherical_actuator_calibration/actuator/urdf_generator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "spherical_actuator_calibration/actuator/rotor_mass.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "urdf_elements.hpp"

#include <tinyxml2.h>

namespace sac {
namespace {

using tinyxml2::XMLElement;

// What holds the stator: drawn only, hence no part of the dimensions [m].
constexpr int kRods = 4;
constexpr double kRodRadius = 0.005;
constexpr double kRingHeight = 0.006;
constexpr double kBaseHeight = 0.010;
constexpr double kPostRadius = 0.006;
constexpr double kBallRadius = 0.010;
constexpr double kCarrierHeight = 0.004;

/// A ring is drawn as so many boxes: URDF has no tubes.
constexpr int kRingSegments = 48;

struct Material {
  const char* name;
  const char* rgba;
};
constexpr std::array<Material, 7> kMaterials = {{{"shell", "0.6 0.62 0.66 0.15"},
                                                 {"frame", "0.62 0.64 0.68 1"},
                                                 {"copper", "0.72 0.45 0.2 1"},
                                                 {"iron", "0.35 0.36 0.4 0.55"},
                                                 {"carrier", "0.9 0.9 0.88 1"},
                                                 {"north", "0.85 0.15 0.15 1"},
                                                 {"south", "0.15 0.3 0.85 1"}}};

std::string shortest(double value) {
  return shortestText(value + 0.0);
}

/// To nanometres or nanoradians: the last digits of sines differ between machines.
std::string rounded(double value) {
  constexpr double kResolution = 1e9;
  return shortest(std::round(value * kResolution) / kResolution);
}

std::string rounded(const Eigen::Vector3d& v) {
  return rounded(v.x()) + ' ' + rounded(v.y()) + ' ' + rounded(v.z());
}

/// To six significant digits; what is nothing but the round-off of `scale` becomes zero.
std::string significant(double value, double scale) {
  constexpr double kRoundOff = 1e-9;
  if (std::abs(value) < kRoundOff * scale) {
    return "0";
  }
  constexpr int kDigits = 6;
  return roundedText(value, kDigits);
}

XMLElement& addChild(XMLElement& parent, const char* name) {
  return *parent.InsertNewChildElement(name);
}

/// Place of a body in its link.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();       ///< roll, pitch, yaw [rad]
};

/// Place of a cylinder, whose own axis is z, along a ray from the centre.
Pose alongAxis(double polar, double azimuth, double distance) {
  return {distance * axisFromAngles(polar, azimuth), {0.0, 0.5 * kPi - polar, azimuth}};
}

void addOrigin(XMLElement& parent, const Pose& pose) {
  XMLElement& origin = addChild(parent, "origin");
  origin.SetAttribute("xyz", rounded(pose.position).c_str());
  origin.SetAttribute("rpy", rounded(pose.rpy).c_str());
}

void addCylinder(XMLElement& body, double radius, double length) {
  XMLElement& cylinder = addChild(addChild(body, "geometry"), "cylinder");
  cylinder.SetAttribute("radius", rounded(radius).c_str());
  cylinder.SetAttribute("length", rounded(length).c_str());
}

/// Bodies of one link.
class LinkDrawing {
 public:
  explicit LinkDrawing(XMLElement& link) : link_(link) {}

  void cylinder(const std::string& name,
                const char* material,
                const Pose& pose,
                double radius,
                double length) {
    XMLElement& visual = addVisual(name, pose);
    addCylinder(visual, radius, length);
    setMaterial(visual, material);
  }

  void sphere(const std::string& name, const char* material, double radius) {
    XMLElement& visual = addVisual(name, {});
    addChild(addChild(visual, "geometry"), "sphere")
        .SetAttribute("radius", rounded(radius).c_str());
    setMaterial(visual, material);
  }

  /// A tube around the z axis at height `z`.
  void ring(const std::string& name,
            const char* material,
            double inner_radius,
            double outer_radius,
            double height,
            double z) {
    const double middle = 0.5 * (inner_radius + outer_radius);
    const Eigen::Vector3d size(
        outer_radius - inner_radius, 2.0 * middle * std::tan(kPi / kRingSegments), height);
    for (int n = 0; n < kRingSegments; ++n) {
      const double azimuth = 2.0 * kPi * n / kRingSegments;
      const Eigen::Vector3d centre(middle * std::cos(azimuth), middle * std::sin(azimuth), z);
      XMLElement& visual = addVisual(name, {centre, {0.0, 0.0, azimuth}});
      addChild(addChild(visual, "geometry"), "box").SetAttribute("size", rounded(size).c_str());
      setMaterial(visual, material);
    }
  }

 private:
  XMLElement& addVisual(const std::string& name, const Pose& pose) {
    XMLElement& visual = addChild(link_, "visual");
    visual.SetAttribute("name", name.c_str());
    addOrigin(visual, pose);
    return visual;
  }

  static void setMaterial(XMLElement& visual, const char* name) {
    addChild(visual, "material").SetAttribute("name", name);
  }

  XMLElement& link_;
};

class RobotWriter {
 public:
  RobotWriter(const Actuator& actuator,
              const ActuatorDimensions& dimensions,
              const std::string& frame_prefix)
      : actuator_(actuator), d_(dimensions), prefix_(frame_prefix) {}

  std::string text() {
    xml_.InsertEndChild(xml_.NewDeclaration("xml version=\"1.0\""));
    xml_.InsertEndChild(
        xml_.NewComment(" Written by generate_urdf from the description of the actuator. "));
    robot_ = xml_.NewElement("robot");
    xml_.InsertEndChild(robot_);
    robot_->SetAttribute("name", actuator_.name.c_str());
    addMaterials();
    addStator();
    if (actuator_.has_joints) {
      addLink("joint_1");
      addLink("joint_2");
    }
    addRotor();
    if (actuator_.has_joints) {
      addJoints();
    } else {
      addJoint(kFloatingJoint, "floating", "stator", "rotor");
    }
    tinyxml2::XMLPrinter printer;
    xml_.Print(&printer);
    return printer.CStr();
  }

 private:
  void addMaterials() {
    for (const Material& material : kMaterials) {
      XMLElement& element = addChild(*robot_, "material");
      element.SetAttribute("name", material.name);
      addChild(element, "color").SetAttribute("rgba", material.rgba);
    }
  }

  XMLElement& addLink(const std::string& name) {
    XMLElement& link = addChild(*robot_, "link");
    link.SetAttribute("name", (prefix_ + name).c_str());
    return link;
  }

  /// Height [m] of the rings above and below the coils.
  double ringHeight() const {
    double highest = 0.0;
    for (const CoilAxis& coil : actuator_.coils) {
      highest = std::max(highest, std::abs(std::sin(coil.polar)));
    }
    const double wanted = d_.outer_shell_radius * highest + d_.coil_radius + kRingHeight;
    // Coils at the poles of the sphere: the ring stays where the sphere still has some width.
    return std::min(wanted, 0.8 * d_.inner_shell_radius);
  }

  void addStator() {
    LinkDrawing stator(addLink("stator"));
    const double z = ringHeight();
    const double inner = std::sqrt(d_.inner_shell_radius * d_.inner_shell_radius - z * z);
    const double outer = std::sqrt(d_.outer_shell_radius * d_.outer_shell_radius - z * z);
    stator.ring("upper_ring", "frame", inner, outer, kRingHeight, z);
    stator.ring("lower_ring", "frame", inner, outer, kRingHeight, -z);
    for (std::size_t j = 0; j < actuator_.coils.size(); ++j) {
      const CoilAxis& coil = actuator_.coils[j];
      stator.cylinder("coil_" + std::to_string(numberOf(j)),
                      "copper",
                      alongAxis(coil.polar, coil.azimuth, d_.coilDistance()),
                      d_.coil_radius,
                      d_.coil_height);
    }
    addBase(stator, z);
    // Last: what is transparent is drawn over the rest.
    stator.sphere("shell", "shell", d_.outer_shell_radius);
  }

  /// A plate below the shell, rods that carry the shell, and a post that carries the joint.
  void addBase(LinkDrawing& stator, double top) const {
    const double plate = -1.25 * d_.outer_shell_radius;
    const double rod_distance = d_.outer_shell_radius + kRodRadius;
    stator.cylinder("base",
                    "frame",
                    {{0.0, 0.0, plate - 0.5 * kBaseHeight}, Eigen::Vector3d::Zero()},
                    rod_distance + 2.0 * kRodRadius,
                    kBaseHeight);
    for (int n = 0; n < kRods; ++n) {
      const double azimuth = 2.0 * kPi * (n + 0.5) / kRods;
      const Eigen::Vector3d centre(
          rod_distance * std::cos(azimuth), rod_distance * std::sin(azimuth), 0.5 * (top + plate));
      stator.cylinder("rod_" + std::to_string(n + 1),
                      "frame",
                      {centre, Eigen::Vector3d::Zero()},
                      kRodRadius,
                      top - plate);
    }
    if (!actuator_.has_joints) {
      return;
    }
    stator.cylinder(
        "post", "frame", {{0.0, 0.0, 0.5 * plate}, Eigen::Vector3d::Zero()}, kPostRadius, -plate);
    stator.sphere("ball", "frame", kBallRadius);
  }

  void addRotor() {
    XMLElement& link = addLink("rotor");
    addInertia(link);
    LinkDrawing rotor(link);
    for (std::size_t i = 0; i < actuator_.poles.size(); ++i) {
      const PoleAxis& pole = actuator_.poles[i];
      rotor.cylinder("pole_" + std::to_string(numberOf(i)),
                     pole.polarity > 0 ? "north" : "south",
                     alongAxis(pole.polar, pole.azimuth, d_.poleDistance()),
                     d_.pole_radius,
                     d_.pole_height);
    }
    const double hoop_inside = d_.rotor_radius - d_.hoop_thickness;
    rotor.cylinder("carrier", "carrier", {}, hoop_inside - d_.pole_height, kCarrierHeight);
    if (actuator_.has_joints) {
      rotor.cylinder("shaft",
                     "carrier",
                     {{0.0, 0.0, 0.5 * d_.shaft_length}, Eigen::Vector3d::Zero()},
                     d_.shaft_radius,
                     d_.shaft_length);
    }
    rotor.ring("hoop", "iron", hoop_inside, d_.rotor_radius, d_.hoop_height, 0.0);
    addCylinder(addChild(link, "collision"), d_.rotor_radius, d_.hoop_height);
  }

  void addInertia(XMLElement& link) const {
    const MassProperties rotor = rotorMass(actuator_, d_);
    XMLElement& inertial = addChild(link, "inertial");
    addOrigin(inertial, {rotor.centre, Eigen::Vector3d::Zero()});
    addChild(inertial, "mass").SetAttribute("value", significant(rotor.mass, rotor.mass).c_str());
    XMLElement& inertia = addChild(inertial, "inertia");
    const char* const names[3][3] = {
        {"ixx", "ixy", "ixz"}, {nullptr, "iyy", "iyz"}, {nullptr, nullptr, "izz"}};
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = row; column < 3; ++column) {
        inertia.SetAttribute(
            names[row][column],
            significant(rotor.inertia(row, column), rotor.inertia.trace()).c_str());
      }
    }
  }

  XMLElement& addJoint(const std::string& name,
                       const char* type,
                       const char* parent,
                       const char* child) {
    XMLElement& joint = addChild(*robot_, "joint");
    joint.SetAttribute("name", name.c_str());
    joint.SetAttribute("type", type);
    addChild(joint, "origin").SetAttribute("xyz", "0 0 0");
    addChild(joint, "parent").SetAttribute("link", (prefix_ + parent).c_str());
    addChild(joint, "child").SetAttribute("link", (prefix_ + child).c_str());
    return joint;
  }

  void addJoints() {
    const std::array<const char*, kJoints + 1> links = {"stator", "joint_1", "joint_2", "rotor"};
    for (std::size_t k = 0; k < kJoints; ++k) {
      const bool is_spin = k + 1 == kJoints;
      XMLElement& joint = addJoint(
          actuator_.joints[k].name, is_spin ? "continuous" : "revolute", links[k], links[k + 1]);
      writeJointAxis(joint, actuator_.joints[k]);
      XMLElement& limit = addChild(joint, "limit");
      if (!is_spin) {
        limit.SetAttribute("lower", rounded(-actuator_.workspace.tilt_limit).c_str());
        limit.SetAttribute("upper", rounded(actuator_.workspace.tilt_limit).c_str());
      }
      limit.SetAttribute("effort", rounded(d_.torque_limit).c_str());
      limit.SetAttribute("velocity",
                         rounded(is_spin ? d_.spin_rate_limit : d_.tilt_rate_limit).c_str());
    }
  }

  const Actuator& actuator_;
  const ActuatorDimensions& d_;
  std::string prefix_;
  tinyxml2::XMLDocument xml_;
  XMLElement* robot_ = nullptr;
};

}  // namespace

std::string renderUrdf(const Actuator& actuator,
                       const ActuatorDimensions& dimensions,
                       const std::string& frame_prefix) {
  validate(actuator);
  validate(dimensions);
  return RobotWriter(actuator, dimensions, frame_prefix).text();
}

}  // namespace sac
