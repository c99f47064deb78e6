#include "spherical_actuator_calibration/ros/calibration_markers.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace spherical_actuator_calibration {
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

TEST(CalibrationMarkers, TheExcitedCoilGlows) {
  CalibrationScene scene = paperScene();
  scene.currents = Eigen::VectorXd::Zero(24);
  scene.currents[5] = -2.0;
  const auto array = calibrationMarkers(scene);
  EXPECT_GT(markerOf(array, "coils", 5).color.g, markerOf(array, "coils", 6).color.g + 0.3F);
  EXPECT_GT(markerOf(array, "coils", 5).scale.x, markerOf(array, "coils", 6).scale.x);
}

TEST(CalibrationMarkers, ADotForEachSample) {
  CalibrationScene scene = paperScene();
  EXPECT_EQ(markerOf(calibrationMarkers(scene), "samples", 0).action, Marker::DELETE);
  scene.sampled_directions = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d(0.6, 0.0, 0.8)};
  const Marker samples = markerOf(calibrationMarkers(scene), "samples", 0);
  EXPECT_EQ(samples.action, Marker::ADD);
  ASSERT_EQ(samples.points.size(), 2U);
  EXPECT_NEAR(samples.points[1].x / samples.points[1].z, 0.75, 1e-12);
}

}  // namespace
}  // namespace spherical_actuator_calibration
