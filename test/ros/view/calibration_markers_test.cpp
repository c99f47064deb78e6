#include "spherical_actuator_calibration/ros/view/calibration_markers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

using visualization_msgs::Marker;

CalibrationScene paperScene() {
  CalibrationScene scene;
  scene.nominal = scenarios::paperNominal();
  scene.identified = scenarios::paperTruth();
  return scene;
}

std::map<std::string, int> countsOf(const visualization_msgs::MarkerArray& array) {
  std::map<std::string, int> counts;
  for (const Marker& marker : array.markers) {
    ++counts[marker.ns];
  }
  return counts;
}

const Marker& markerOf(const visualization_msgs::MarkerArray& array,
                       const std::string& group,
                       int id) {
  for (const Marker& marker : array.markers) {
    if (marker.ns == group && marker.id == id) {
      return marker;
    }
  }
  throw std::out_of_range(group);
}

Eigen::Vector3d directionOf(const Marker& arrow) {
  const auto& tip = arrow.points[1];
  return Eigen::Vector3d(tip.x, tip.y, tip.z).normalized();
}

TEST(CalibrationMarkers, ShowEveryPoleAndCoilTwice) {
  CalibrationScene scene = paperScene();
  std::map<std::string, int> counts = countsOf(calibrationMarkers(scene));
  EXPECT_EQ(counts["poles"], 8);
  EXPECT_EQ(counts["nominal poles"], 8);
  EXPECT_EQ(counts["coils"], 24);
  EXPECT_EQ(counts["nominal coils"], 24);
  scene.nominal.poles.resize(6);
  scene.identified.poles.resize(6);
  scene.nominal.coils.resize(12);
  scene.identified.coils.resize(12);
  counts = countsOf(calibrationMarkers(scene));
  EXPECT_EQ(counts["poles"], 6);
  EXPECT_EQ(counts["coils"], 12);
}

Eigen::Vector3d axisOf(const Marker& cylinder) {
  const auto& q = cylinder.pose.orientation;
  return Eigen::Quaterniond(q.w, q.x, q.y, q.z) * Eigen::Vector3d::UnitZ();
}

TEST(CalibrationMarkers, JointsAreAGimbalThatTurnsWithTheirFrames) {
  CalibrationScene scene = paperScene();
  scene.magnification = 1.0;
  const auto array = calibrationMarkers(scene);
  const Eigen::Matrix3d axes = jointGeometry(scene.identified).axes;
  const char* const frames[] = {"stator", "joint_1", "joint_2"};
  for (int joint = 0; joint < 3; ++joint) {
    const Marker& rod = markerOf(array, "joints", joint);
    EXPECT_EQ(rod.header.frame_id, frames[joint]);
    EXPECT_NEAR(std::abs(axisOf(rod).dot(axes.col(joint).normalized())), 1.0, 1e-9);
    // To be seen it comes out of the rotor.
    EXPECT_GT(0.5 * rod.scale.z, scene.dimensions.rotor_radius);
  }
  const Marker& ring = markerOf(array, "joint ring", 0);
  EXPECT_EQ(ring.header.frame_id, "joint_1");
  const Eigen::Vector3d normal = axes.col(0).cross(axes.col(1)).normalized();
  for (const auto& point : ring.points) {
    const Eigen::Vector3d at(point.x, point.y, point.z);
    EXPECT_NEAR(at.dot(normal), 0.0, 1e-9);
    EXPECT_GT(at.norm(), scene.dimensions.rotor_radius);
  }
}

TEST(CalibrationMarkers, WithoutJointsThereIsNoGimbal) {
  CalibrationScene scene = paperScene();
  scene.nominal.has_joints = scene.identified.has_joints = false;
  EXPECT_EQ(countsOf(calibrationMarkers(scene)).count("joints"), 0U);
}

TEST(CalibrationMarkers, ColourPolesByPolarity) {
  const auto array = calibrationMarkers(paperScene());
  for (int pole = 0; pole < 8; ++pole) {
    const Marker& marker = markerOf(array, "poles", pole);
    EXPECT_EQ(marker.color.r > marker.color.b, pole % 2 == 0) << pole;
    EXPECT_EQ(marker.header.frame_id, "rotor");
  }
}

TEST(CalibrationMarkers, MagnifyTheErrorsOfAxes) {
  CalibrationScene scene = paperScene();
  const auto angle = [&](double magnification) {
    scene.magnification = magnification;
    const auto array = calibrationMarkers(scene);
    return std::acos(std::min(1.0,
                              directionOf(markerOf(array, "poles", 2))
                                  .dot(directionOf(markerOf(array, "nominal poles", 2)))));
  };
  EXPECT_GT(angle(1.0), 1e-3);
  EXPECT_NEAR(angle(5.0) / angle(1.0), 5.0, 0.2);
}

TEST(CalibrationMarkers, TheExcitedCoilGlowsWithItsCurrent) {
  CalibrationScene scene = paperScene();
  scene.currents = Eigen::VectorXd::Zero(24);
  scene.currents[5] = -2.0;
  scene.currents[6] = 1.0;
  scene.currents[7] = std::numeric_limits<double>::quiet_NaN();
  const auto array = calibrationMarkers(scene);
  const Marker& full = markerOf(array, "currents", 5);
  const Marker& half = markerOf(array, "currents", 6);
  EXPECT_EQ(full.action, Marker::ADD);
  EXPECT_GT(full.color.a, 0.7F);
  EXPECT_NEAR(half.color.a, 0.5F * full.color.a, 1e-6F);
  EXPECT_EQ(markerOf(array, "currents", 4).action, Marker::DELETE);
  EXPECT_EQ(markerOf(array, "currents", 7).action, Marker::DELETE);
  const Eigen::Vector3d axis =
      axisFromAngles(scene.nominal.coils[5].polar, scene.nominal.coils[5].azimuth);
  const auto& at = full.pose.position;
  EXPECT_LT((Eigen::Vector3d(at.x, at.y, at.z) - 0.1 * axis).norm(), 1e-12);
}

TEST(CalibrationMarkers, ConesStandWhereAxesAreIdentified) {
  CalibrationScene scene = paperScene();
  scene.magnification = 20.0;
  scene.pole_stddevs.assign(8, std::nullopt);
  scene.pole_stddevs[2] = 0.01;
  const auto array = calibrationMarkers(scene);
  for (int pole = 0; pole < 8; ++pole) {
    EXPECT_EQ(markerOf(array, "pole uncertainty", pole).action,
              pole == 2 ? Marker::ADD : Marker::DELETE);
  }
  EXPECT_EQ(markerOf(array, "coil uncertainty", 0).action, Marker::DELETE);
  // Half angle: the standard deviation, magnified like the error.
  const Marker& cone = markerOf(array, "pole uncertainty", 2);
  const Eigen::Vector3d axis = directionOf(markerOf(array, "poles", 2));
  ASSERT_EQ(cone.points.size() % 3, 0U);
  double widest = 0.0;
  for (const auto& corner : cone.points) {
    const Eigen::Vector3d at(corner.x, corner.y, corner.z);
    widest = std::max(widest, at.cross(axis).norm() / at.dot(axis));
  }
  EXPECT_NEAR(std::atan(widest), 0.2, 1e-9);
}

TEST(CalibrationMarkers, HopelessUncertaintyIsStillACone) {
  CalibrationScene scene = paperScene();
  scene.coil_stddevs.assign(24, 1e3);
  const visualization_msgs::MarkerArray array = calibrationMarkers(scene);
  const Marker& cone = markerOf(array, "coil uncertainty", 3);
  ASSERT_FALSE(cone.points.empty());
  for (const auto& corner : cone.points) {
    EXPECT_LT(std::hypot(corner.x, corner.y, corner.z), 1.0);
  }
}

TEST(CalibrationMarkers, AGhostOfTheRotorStandsInItsNominalFrame) {
  CalibrationScene scene = paperScene();
  scene.frames.nominal_rotor = "unit_2/rotor_nominal";
  int poles = 0;
  for (const Marker& marker : calibrationMarkers(scene).markers) {
    if (marker.ns == "nominal rotor") {
      EXPECT_EQ(marker.header.frame_id, "unit_2/rotor_nominal");
      EXPECT_LT(marker.color.a, 0.5F);
      poles += marker.scale.x == 0.02 ? 1 : 0;
    }
  }
  EXPECT_EQ(poles, 8);
}

TEST(CalibrationMarkers, AGreenRotorStandsWhereItIsToGo) {
  CalibrationScene scene = paperScene();
  const auto part = [&](int id) { return markerOf(calibrationMarkers(scene), "wanted pose", id); };
  EXPECT_EQ(part(1).action, Marker::DELETE);

  scene.wanted_joint_position = Eigen::Vector3d(0.3, -0.2, 0.5);
  const Eigen::Matrix3d R_stator_rotor =
      rotorOrientation(jointGeometry(scene.identified), *scene.wanted_joint_position);
  const auto place = [](const Marker& marker) {
    const geometry_msgs::Point& at = marker.pose.position;
    return Eigen::Vector3d(at.x, at.y, at.z).normalized();
  };
  const Marker shaft = part(1);
  EXPECT_EQ(shaft.action, Marker::ADD);
  EXPECT_EQ(shaft.header.frame_id, "stator");
  EXPECT_LT((place(shaft) - R_stator_rotor.col(2)).norm(), 1e-12);
  // Poles show a turn about the shaft, too.
  const Eigen::Vector3d pole_rotor = torqueGeometry(scene.nominal).poles_rotor.col(3);
  EXPECT_LT((place(part(5)) - R_stator_rotor * pole_rotor).norm(), 1e-12);
}

std_msgs::ColorRGBA colorOfOnly(const SampledDirection& sample) {
  CalibrationScene scene = paperScene();
  scene.samples = {sample};
  return markerOf(calibrationMarkers(scene), "samples", 0).colors.at(0);
}

TEST(CalibrationMarkers, DotsAreColouredByResidual) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto good = colorOfOnly({up, 0.7, false});
  EXPECT_GT(good.g, 2.0F * good.r);
  const auto middle = colorOfOnly({up, 2.0, false});
  EXPECT_GT(middle.r, good.r);
  const auto bad = colorOfOnly({up, 5.0, false});
  EXPECT_GT(bad.r, 2.0F * bad.g);
  EXPECT_GT(bad.r, middle.r);
  const auto rejected = colorOfOnly({up, 9.0, true});
  EXPECT_EQ(rejected.r + rejected.g + rejected.b, 0.0F);
  const auto unknown = colorOfOnly({up, std::nullopt, false});
  EXPECT_EQ(unknown.r, unknown.g);
}

TEST(CalibrationMarkers, ADotForEachOrientationThatWasSampled) {
  CalibrationScene scene = paperScene();
  EXPECT_EQ(markerOf(calibrationMarkers(scene), "samples", 0).action, Marker::DELETE);
  const Eigen::Vector3d tilted(0.6, 0.0, 0.8);
  scene.samples = {{Eigen::Vector3d::UnitZ(), 1.0, false},
                   {tilted, 1.0, false},
                   {(tilted + Eigen::Vector3d(1e-4, 0.0, 0.0)).normalized(), 4.0, false},
                   {tilted, std::nullopt, false}};
  const Marker dots = markerOf(calibrationMarkers(scene), "samples", 0);
  EXPECT_EQ(dots.action, Marker::ADD);
  ASSERT_EQ(dots.points.size(), 2U);
  ASSERT_EQ(dots.colors.size(), 2U);
  const std::size_t at = dots.points[0].x > dots.points[1].x ? 0 : 1;
  EXPECT_NEAR(dots.points[at].x / dots.points[at].z, 0.75, 1e-3);
  // The worst of the three that stand together.
  EXPECT_GT(dots.colors[at].r, 2.0F * dots.colors[at].g);
}

TEST(CalibrationMarkers, NumbersCountAsMessagesDo) {
  const visualization_msgs::MarkerArray array = calibrationMarkers(paperScene());
  EXPECT_EQ(markerOf(array, "pole numbers", 7).text, "P8");
  const Marker& number = markerOf(array, "coil numbers", 0);
  EXPECT_EQ(number.text, "C1");
  // Outside of everything that stands on its axis.
  const auto distance = [](const geometry_msgs::Point& point) {
    return Eigen::Vector3d(point.x, point.y, point.z).norm();
  };
  for (const geometry_msgs::Point& end : markerOf(array, "coils", 0).points) {
    EXPECT_GT(distance(number.pose.position), distance(end));
  }
  EXPECT_NE(markerOf(array, "legend", 0).text.find("coils"), std::string::npos);
}

TEST(CalibrationMarkers, IdsAreUniqueAndShapesAreFinite) {
  CalibrationScene scene = paperScene();
  scene.pole_stddevs.assign(8, 1e-3);
  scene.coil_stddevs.assign(24, 1e-3);
  scene.samples = {{Eigen::Vector3d::UnitX(), 1.0, false}};
  std::set<std::pair<std::string, int>> ids;
  for (const Marker& marker : calibrationMarkers(scene).markers) {
    EXPECT_TRUE(ids.emplace(marker.ns, marker.id).second) << marker.ns << marker.id;
    EXPECT_GT(marker.scale.x + static_cast<double>(marker.action == Marker::DELETE), 0.0);
    for (const auto& corner : marker.points) {
      EXPECT_TRUE(std::isfinite(corner.x + corner.y + corner.z));
    }
  }
}

}  // namespace
}  // namespace sac
