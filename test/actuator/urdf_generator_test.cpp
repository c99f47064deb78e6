#include "spherical_actuator_calibration/actuator/urdf_generator.hpp"

#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <gtest/gtest.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/rotor_mass.hpp"
#include "spherical_actuator_calibration/actuator/urdf_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

constexpr double kRounding = 1e-8;

/// Six poles in two layers that are no mirror image of each other, and twelve coils in three.
Actuator sixPolesTwelveCoils() {
  Actuator actuator = scenarios::paperNominal();
  actuator.name = "pm_spherical_6x12";
  actuator.poles.clear();
  for (int i = 0; i < 6; ++i) {
    actuator.poles.push_back({i < 3 ? 0.25 : -0.1, i * kPi / 3.0, i % 2 == 0 ? -1 : 1, 1.0});
  }
  actuator.coils.clear();
  for (int j = 0; j < 12; ++j) {
    actuator.coils.push_back({0.4 * (j % 3 - 1), j * kPi / 6.0, 1.0});
  }
  return actuator;
}

urdf::ModelInterfaceSharedPtr parsed(const Actuator& actuator, const std::string& prefix = "") {
  return urdf::parseURDF(renderUrdf(actuator, {}, prefix));
}

/// The visual of a name, of which there must be one.
urdf::VisualSharedPtr visualOf(const urdf::ModelInterface& robot,
                               const std::string& link,
                               const std::string& name) {
  urdf::VisualSharedPtr found;
  for (const auto& visual : robot.getLink(link)->visual_array) {
    if (visual->name == name) {
      EXPECT_FALSE(found) << name;
      found = visual;
    }
  }
  return found;
}

/// Visuals whose name begins with a text.
int countOf(const urdf::ModelInterface& robot, const std::string& link, const std::string& start) {
  int count = 0;
  for (const auto& visual : robot.getLink(link)->visual_array) {
    count += visual->name.rfind(start, 0) == 0 ? 1 : 0;
  }
  return count;
}

/// That a cylinder of the given size stands on an axis at a distance from the centre.
void expectCylinder(const urdf::VisualSharedPtr& visual,
                    const Eigen::Vector3d& axis,
                    double distance,
                    double radius,
                    double length) {
  ASSERT_TRUE(visual);
  const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(visual->geometry.get());
  ASSERT_NE(cylinder, nullptr);
  EXPECT_NEAR(cylinder->radius, radius, kRounding);
  EXPECT_NEAR(cylinder->length, length, kRounding);
  const urdf::Pose& pose = visual->origin;
  const Eigen::Vector3d position(pose.position.x, pose.position.y, pose.position.z);
  const Eigen::Quaterniond rotation(
      pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  EXPECT_LT((position - distance * axis).norm(), kRounding) << visual->name;
  EXPECT_LT((rotation * Eigen::Vector3d::UnitZ() - axis).norm(), kRounding) << visual->name;
}

void expectBodiesOnAxes(const Actuator& actuator) {
  const urdf::ModelInterfaceSharedPtr robot = parsed(actuator);
  ASSERT_TRUE(robot);
  const ActuatorDimensions d;
  EXPECT_EQ(countOf(*robot, "rotor", "pole_"), static_cast<int>(actuator.poles.size()));
  EXPECT_EQ(countOf(*robot, "stator", "coil_"), static_cast<int>(actuator.coils.size()));
  for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
    const PoleAxis& pole = actuator.poles[i];
    const auto visual = visualOf(*robot, "rotor", "pole_" + std::to_string(i + 1));
    // Inside the hoop, against it.
    expectCylinder(
        visual, axisFromAngles(pole.polar, pole.azimuth), 0.0435, d.pole_radius, d.pole_height);
    EXPECT_EQ(visual->material->color.r > visual->material->color.b, pole.polarity > 0);
  }
  for (std::size_t j = 0; j < actuator.coils.size(); ++j) {
    const CoilAxis& coil = actuator.coils[j];
    expectCylinder(visualOf(*robot, "stator", "coil_" + std::to_string(j + 1)),
                   axisFromAngles(coil.polar, coil.azimuth),
                   0.100,
                   d.coil_radius,
                   d.coil_height);
  }
}

void expectPossibleInertia(const Actuator& actuator) {
  const urdf::InertialSharedPtr inertial = parsed(actuator)->getLink("rotor")->inertial;
  ASSERT_TRUE(inertial);
  EXPECT_GT(inertial->mass, 0.0);
  Eigen::Matrix3d inertia;
  inertia << inertial->ixx, inertial->ixy, inertial->ixz,  //
      inertial->ixy, inertial->iyy, inertial->iyz,         //
      inertial->ixz, inertial->iyz, inertial->izz;
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
  EXPECT_GT(moments[0], 0.0);
  EXPECT_GT(moments[0] + moments[1], moments[2]);
}

TEST(UrdfGenerator, TheShippedRobotIsTheOneOfTheShippedDescription) {
  EXPECT_EQ(contentOf(SOURCE_DIR "/urdf/pm_spherical_8x24.urdf"),
            renderUrdf(loadActuator(SOURCE_DIR "/config/pm_spherical_8x24.yaml"),
                       loadDimensions(SOURCE_DIR "/config/actuator_dimensions.yaml")))
      << "Write it anew: generate_urdf --actuator config/pm_spherical_8x24.yaml --output "
         "urdf/pm_spherical_8x24.urdf --force";
}

TEST(UrdfGenerator, TheShippedSphereIsTheOneOfTheShippedDescription) {
  EXPECT_EQ(contentOf(SOURCE_DIR "/urdf/reaction_sphere.urdf"),
            renderUrdf(loadActuator(SOURCE_DIR "/config/reaction_sphere.yaml"),
                       loadDimensions(SOURCE_DIR "/config/actuator_dimensions.yaml")))
      << "Write it anew: generate_urdf --actuator config/reaction_sphere.yaml --output "
         "urdf/reaction_sphere.urdf --force";
}

TEST(UrdfGenerator, WithoutJointsTheRotorFloats) {
  const Actuator sphere = loadActuator(SOURCE_DIR "/config/reaction_sphere.yaml");
  const urdf::ModelInterfaceSharedPtr robot = parsed(sphere, "unit_2/");
  ASSERT_EQ(robot->joints_.size(), 1U);
  const urdf::JointConstSharedPtr joint = robot->getJoint(kFloatingJoint);
  ASSERT_TRUE(joint);
  EXPECT_EQ(joint->type, urdf::Joint::FLOATING);
  EXPECT_EQ(joint->parent_link_name, "unit_2/stator");
  EXPECT_EQ(joint->child_link_name, "unit_2/rotor");
  EXPECT_EQ(countOf(*robot, "unit_2/stator", "coil_"), 20);
  EXPECT_EQ(countOf(*robot, "unit_2/stator", "post"), 0);
  EXPECT_EQ(countOf(*robot, "unit_2/rotor", "pole_"), 8);
  expectPossibleInertia(sphere);
}

TEST(UrdfGenerator, WithoutJointsNothingIsCalibratedInIt) {
  const Actuator sphere = loadActuator(SOURCE_DIR "/config/reaction_sphere.yaml");
  const std::string text = renderUrdf(sphere, {});
  EXPECT_EQ(renderCalibratedUrdf(text, "r", sphere, sphere), text);
  const std::string jointed = renderUrdf(scenarios::paperNominal(), {});
  EXPECT_EQ(errorMessage<ConfigError>([&] { renderCalibratedUrdf(jointed, "r", sphere, sphere); }),
            "r: the actuator description has no joints, but no joint here is floating.");
}

TEST(UrdfGenerator, PolesAndCoilsStandOnTheirAxes) {
  expectBodiesOnAxes(scenarios::paperNominal());
  expectBodiesOnAxes(sixPolesTwelveCoils());
}

TEST(UrdfGenerator, InertiasArePossible) {
  expectPossibleInertia(scenarios::paperNominal());
  expectPossibleInertia(sixPolesTwelveCoils());
}

TEST(UrdfGenerator, OffCentreMassStandsWhereItIs) {
  const auto centre = parsed(sixPolesTwelveCoils())->getLink("rotor")->inertial->origin.position;
  const MassProperties rotor = rotorMass(sixPolesTwelveCoils(), {});
  EXPECT_GT(rotor.centre.norm(), 1e-3);
  EXPECT_LT((Eigen::Vector3d(centre.x, centre.y, centre.z) - rotor.centre).norm(), kRounding);
}

TEST(UrdfGenerator, JointsAreThoseOfTheDescription) {
  const TemporaryFolder folder;
  // Axes and offsets that need all their digits.
  const Actuator actuator = scenarios::paperTruth();
  const auto joints = readJoints(folder.write("a.urdf", renderUrdf(actuator, {})),
                                 {"joint_1", "joint_2", "joint_3"});
  for (std::size_t k = 0; k < kJoints; ++k) {
    EXPECT_LT((joints[k].axis - actuator.joints[k].axis).norm(), 1e-12);
    EXPECT_NEAR(joints[k].offset, actuator.joints[k].offset, 1e-12);
  }
  const urdf::ModelInterfaceSharedPtr robot = parsed(actuator);
  EXPECT_EQ(robot->getRoot()->name, "stator");
  EXPECT_EQ(robot->getJoint("joint_2")->limits->upper, actuator.workspace.tilt_limit);
  EXPECT_EQ(robot->getJoint("joint_3")->type, urdf::Joint::CONTINUOUS);
}

TEST(UrdfGenerator, IsATemplateForTheCalibratedDescription) {
  const Actuator nominal = sixPolesTwelveCoils();
  Actuator calibrated = nominal;
  calibrated.joints = scenarios::paperTruth().joints;
  const std::string text =
      renderCalibratedUrdf(renderUrdf(nominal, {}, "unit_2/"), "r", nominal, calibrated);
  const TemporaryFolder folder;
  const auto joints = readJoints(folder.write("a.urdf", text), {"joint_1", "joint_2", "joint_3"});
  EXPECT_LT((joints[2].axis - calibrated.joints[2].axis).norm(), 1e-12);
}

TEST(UrdfGenerator, ThePrefixIsThatOfTheFrames) {
  const urdf::ModelInterfaceSharedPtr robot = parsed(scenarios::paperNominal(), "unit_2/");
  EXPECT_EQ(robot->getRoot()->name, "unit_2/stator");
  EXPECT_TRUE(robot->getLink("unit_2/rotor"));
  EXPECT_TRUE(robot->getJoint("joint_1"));
}

TEST(UrdfGenerator, WithoutPolesAndCoilsTheJointRemains) {
  Actuator actuator = scenarios::paperNominal();
  actuator.poles.clear();
  actuator.coils.clear();
  actuator.torque_curve.reset();
  expectBodiesOnAxes(actuator);
  expectPossibleInertia(actuator);
}

TEST(UrdfGenerator, CoilsNearTheTopAreDrawnToo) {
  Actuator actuator = sixPolesTwelveCoils();
  actuator.coils[0].polar = 1.5;
  expectBodiesOnAxes(actuator);
}

}  // namespace
}  // namespace sac
