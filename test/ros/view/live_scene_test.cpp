#include "spherical_actuator_calibration/ros/view/live_scene.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

LiveScene paperScene() {
  CalibrationScene start;
  start.nominal = scenarios::paperNominal();
  return LiveScene(start);
}

msg::ActuatorParameters parametersOf(const Actuator& actuator, const std::string& source) {
  msg::ActuatorParameters message = parametersToRos(actuator);
  message.source = source;
  return message;
}

/// A report of one axis.
msg::CalibrationReport reportOf(const std::string& axis,
                                double polar_stddev,
                                double azimuth_stddev) {
  CycleReport report;
  report.cycle = Cycle::kPoles;
  report.success = true;
  report.estimates.resize(2);
  report.estimates[0].name = axis + "/polar";
  report.estimates[0].stddev = polar_stddev;
  report.estimates[1].name = axis + "/azimuth";
  report.estimates[1].stddev = azimuth_stddev;
  for (ParameterEstimate& estimate : report.estimates) {
    estimate.observable = true;
  }
  return reportToRos(report);
}

msg::CalibrationSample sampleOf(std::uint32_t id) {
  msg::CalibrationSample sample;
  sample.id = id;
  sample.has_orientation = 1;
  sample.orientation.w = 1.0;
  return sample;
}

TEST(LiveScene, TakesTheParametersInForce) {
  LiveScene scene = paperScene();
  const Actuator truth = scenarios::paperTruth();
  scene.receive(parametersOf(truth, "identified"));
  EXPECT_EQ(scene.joints()[1].offset, truth.joints[1].offset);
  EXPECT_EQ(scene.scene().identified.poles[3].azimuth, truth.poles[3].azimuth);
  EXPECT_EQ(scene.scene().nominal.poles[3].azimuth, scenarios::paperNominal().poles[3].azimuth);
}

TEST(LiveScene, AnotherDesignChangesNothing) {
  LiveScene scene = paperScene();
  Actuator other = scenarios::paperTruth();
  other.coils.pop_back();
  scene.receive(parametersOf(other, "identified"));
  EXPECT_EQ(scene.joints()[1].offset, 0.0);
  msg::CoilCurrents currents;
  currents.current.assign(23, 1.0);
  scene.receive(currents);
  EXPECT_EQ(scene.scene().currents.size(), 0);
}

TEST(LiveScene, OnlyIdentifiedAxesHaveAnUncertainty) {
  LiveScene scene = paperScene();
  scene.receive(reportOf("pole_2", 1e-3, 2e-3));
  // Parameters and report come in any order.
  EXPECT_FALSE(scene.scene().pole_stddevs[1]);
  scene.receive(parametersOf(scenarios::paperTruth(), "identified"));
  ASSERT_TRUE(scene.scene().pole_stddevs[1]);
  EXPECT_NEAR(*scene.scene().pole_stddevs[1], 2e-3, 1e-6);
  EXPECT_FALSE(scene.scene().pole_stddevs[0]);
  EXPECT_FALSE(scene.scene().coil_stddevs[1]);

  msg::CalibrationReport lost = reportOf("pole_2", 1e-3, 2e-3);
  lost.estimates[1].observable = 0;
  scene.receive(lost);
  EXPECT_FALSE(scene.scene().pole_stddevs[1]);
}

TEST(LiveScene, AFailedCycleLeavesTheUncertainty) {
  LiveScene scene = paperScene();
  scene.receive(parametersOf(scenarios::paperTruth(), "identified"));
  scene.receive(reportOf("coil_7", 1e-3, 1e-3));
  msg::CalibrationReport failed = reportOf("coil_7", 0.5, 0.5);
  failed.success = 0;
  scene.receive(failed);
  EXPECT_NEAR(scene.scene().coil_stddevs[6].value_or(0.0), 1e-3, 1e-9);
}

TEST(LiveScene, NominalParametersHaveNoUncertainty) {
  LiveScene scene = paperScene();
  scene.receive(parametersOf(scenarios::paperTruth(), "identified"));
  scene.receive(reportOf("pole_2", 1e-3, 2e-3));
  scene.receive(parametersOf(scenarios::paperNominal(), "nominal"));
  EXPECT_FALSE(scene.scene().pole_stddevs[1]);
  // And none comes back with the next cycle's parameters.
  scene.receive(parametersOf(scenarios::paperTruth(), "identified"));
  EXPECT_FALSE(scene.scene().pole_stddevs[1]);
}

TEST(LiveScene, ResidualsGoToTheirSamples) {
  LiveScene scene = paperScene();
  scene.receive(sampleOf(3));
  scene.receive(sampleOf(4));
  CycleReport report;
  report.residuals.resize(1);
  report.residuals[0].id = 4;
  report.residuals[0].standardized = 3.5;
  report.residuals[0].rejected = true;
  scene.receive(reportToRos(report));
  const auto samples = scene.scene().samples;
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_FALSE(samples[0].standardized);
  EXPECT_EQ(samples[1].standardized.value_or(0.0), 3.5);
  EXPECT_TRUE(samples[1].rejected);
}

TEST(LiveScene, SamplesWithoutOrientationStandWhereTheirJointsWere) {
  LiveScene scene = paperScene();
  msg::CalibrationSample sample = sampleOf(1);
  sample.has_orientation = 0;
  sample.joint_position = {0.3, 0.0, 1.0};
  scene.receive(sample);
  const Eigen::Vector3d direction = scene.scene().samples.at(0).direction_stator;
  EXPECT_NEAR(direction.y(), -std::sin(0.3), 1e-12);
  EXPECT_NEAR(direction.z(), std::cos(0.3), 1e-12);
}

TEST(LiveScene, ChangesAreToldOnceAndSmallCurrentsNot) {
  LiveScene scene = paperScene();
  EXPECT_TRUE(scene.takeChange());
  EXPECT_FALSE(scene.takeChange());
  msg::CoilCurrents currents;
  currents.current.assign(24, 0.0);
  scene.receive(currents);
  EXPECT_TRUE(scene.takeChange());
  currents.current[3] = 0.005;
  scene.receive(currents);
  EXPECT_FALSE(scene.takeChange());
  currents.current[3] = 2.0;
  scene.receive(currents);
  EXPECT_TRUE(scene.takeChange());
}

}  // namespace
}  // namespace sac
