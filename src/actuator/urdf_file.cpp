#include "spherical_actuator_calibration/actuator/urdf_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include "spherical_actuator_calibration/base/angle_difference.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "urdf_elements.hpp"
#include "xml_limits.hpp"

#include <tinyxml2.h>

namespace sac {
namespace {

/// Largest difference [rad] between two descriptions of one nominal joint.
constexpr double kAngleTolerance = 1e-6;

/// One file, read as XML (to edit it) and by the reference reader (to understand it).
class RobotDescription {
 public:
  explicit RobotDescription(const std::string& path)
      : RobotDescription(readInputFile(path), path) {}

  /// From its text; `name` stands for the file in messages.
  RobotDescription(const std::string& text, const std::string& name) : path_(name) {
    const std::size_t line = lineOfManyAttributes(text);
    if (line > 0) {
      throw ConfigError(path_ + ":" + std::to_string(line) + ": an element has more than " +
                        std::to_string(kMostAttributes) +
                        " attributes, where URDF knows a handful: take out what does not belong.");
    }
    require(xml_.Parse(text.c_str(), text.size()));
    // What is no XML, such as a bare ampersand, the two readers take for different things:
    // understood is what will be written, and that must stay what it is.
    const std::string written = this->text();
    tinyxml2::XMLDocument again;
    require(again.Parse(written.c_str(), written.size()));
    if (textOf(again) != written) {
      throw ConfigError(path_ + ": cannot be read as XML: written again it is something else.");
    }
    understand(urdf::parseURDF(written));
  }

  const urdf::Joint& joint(const std::string& name) const {
    const auto place = model_->joints_.find(name);
    if (place == model_->joints_.end()) {
      throw ConfigError(path_ + ": the joint \"" + name + "\" is missing.");
    }
    return *place->second;
  }

  bool hasFloatingJoint() const {
    return std::any_of(model_->joints_.begin(), model_->joints_.end(), [](const auto& named) {
      return named.second->type == urdf::Joint::FLOATING;
    });
  }

  /// The XML element of a joint that the model has.
  tinyxml2::XMLElement& element(const std::string& name) {
    tinyxml2::XMLElement* joint = xml_.RootElement()->FirstChildElement("joint");
    while (joint != nullptr && !joint->Attribute("name", name.c_str())) {
      joint = joint->NextSiblingElement("joint");
    }
    if (joint == nullptr) {
      fail(name, "its element was not found.");
    }
    return *joint;
  }

  std::string text() const { return textOf(xml_); }

  [[noreturn]] void fail(const std::string& sentence) const {
    throw ConfigError(path_ + ": " + sentence);
  }
  [[noreturn]] void fail(const std::string& joint, const std::string& sentence) const {
    throw ConfigError(path_ + ": joint \"" + joint + "\": " + sentence);
  }

 private:
  static std::string textOf(const tinyxml2::XMLDocument& xml) {
    tinyxml2::XMLPrinter printer;
    xml.Print(&printer);
    return printer.CStr();
  }

  void require(tinyxml2::XMLError error) const {
    if (error != tinyxml2::XML_SUCCESS) {
      throw ConfigError(path_ + ": cannot be read as XML: " + xml_.ErrorStr() + ".");
    }
  }

  void understand(urdf::ModelInterfaceSharedPtr model) {
    if (!model || xml_.RootElement() == nullptr) {
      throw ConfigError(path_ + ": this is not a robot description (URDF); check_urdf tells why.");
    }
    model_ = std::move(model);
  }

  std::string path_;
  tinyxml2::XMLDocument xml_;
  urdf::ModelInterfaceSharedPtr model_;
};

void requireChain(const RobotDescription& robot, const JointNames& names) {
  for (std::size_t k = 0; k < kJoints; ++k) {
    const urdf::Joint& joint = robot.joint(names[k]);
    if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS) {
      robot.fail(names[k], "its type must be revolute or continuous.");
    }
    if (k == 0) {
      continue;
    }
    const std::string& link = robot.joint(names[k - 1]).child_link_name;
    if (joint.parent_link_name != link) {
      robot.fail(names[k],
                 "its parent link is \"" + joint.parent_link_name + "\"; it must be \"" + link +
                     "\", the child link of \"" + names[k - 1] + "\".");
    }
  }
}

JointAxis readJoint(const RobotDescription& robot, const std::string& name) {
  const urdf::Joint& joint = robot.joint(name);
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!axis.allFinite() || !(axis.stableNorm() > 0.0)) {
    robot.fail(name, "its axis has no direction.");
  }
  const urdf::Rotation& origin = joint.parent_to_joint_origin_transform.rotation;
  const Eigen::Quaterniond rotation(origin.w, origin.x, origin.y, origin.z);
  if (!rotation.coeffs().allFinite()) {
    robot.fail(name, "its origin is not finite.");
  }
  // From the quaternion: the matrix's logarithm loses digits near π.
  const Eigen::AngleAxisd turn(rotation);
  const Eigen::Vector3d rotation_vector = turn.angle() * turn.axis();
  const Eigen::Vector3d unit_axis = axis.stableNormalized();
  const double offset = rotation_vector.dot(unit_axis);
  if ((rotation_vector - offset * unit_axis).norm() > kAngleTolerance) {
    robot.fail(name, "its origin turns about another axis than the joint itself.");
  }
  return {name, unit_axis, offset};
}

JointNames namesOf(const Actuator& actuator) {
  JointNames names;
  for (std::size_t k = 0; k < kJoints; ++k) {
    names[k] = actuator.joints[k].name;
  }
  return names;
}

void requireNominal(const RobotDescription& robot, const JointAxis& nominal) {
  const JointAxis joint = readJoint(robot, nominal.name);
  if ((joint.axis - nominal.axis.normalized()).norm() > kAngleTolerance) {
    robot.fail(nominal.name,
               "its axis is not the nominal one of the actuator description; give the nominal "
               "robot description.");
  }
  // Modulo full turns: both offsets stand for the same rotation.
  if (std::abs(angleDifference(joint.offset, nominal.offset)) > kAngleTolerance) {
    robot.fail(nominal.name,
               "the rotation of its origin is not the nominal offset of the actuator description; "
               "give the nominal robot description.");
  }
}

std::string calibratedText(RobotDescription& robot,
                           const Actuator& nominal,
                           const Actuator& calibrated) {
  validate(nominal);
  validate(calibrated);
  if (!nominal.has_joints) {
    if (!robot.hasFloatingJoint()) {
      robot.fail("the actuator description has no joints, but no joint here is floating.");
    }
    return robot.text();
  }
  requireChain(robot, namesOf(nominal));
  for (std::size_t k = 0; k < kJoints; ++k) {
    requireNominal(robot, nominal.joints[k]);
    writeJointAxis(robot.element(nominal.joints[k].name), calibrated.joints[k]);
  }
  return robot.text();
}

}  // namespace

std::array<JointAxis, kJoints> readJoints(const std::string& path, const JointNames& names) {
  const RobotDescription robot(path);
  requireChain(robot, names);
  std::array<JointAxis, kJoints> joints;
  for (std::size_t k = 0; k < kJoints; ++k) {
    joints[k] = readJoint(robot, names[k]);
  }
  return joints;
}

void writeCalibratedUrdf(const std::string& template_path,
                         const std::string& output_path,
                         const Actuator& nominal,
                         const Actuator& calibrated,
                         OverwritePolicy policy) {
  RobotDescription robot(template_path);
  writeFileAtomically(output_path, calibratedText(robot, nominal, calibrated), policy);
}

std::string renderCalibratedUrdf(const std::string& template_text,
                                 const std::string& name,
                                 const Actuator& nominal,
                                 const Actuator& calibrated) {
  RobotDescription robot(template_text, name);
  return calibratedText(robot, nominal, calibrated);
}

}  // namespace sac
