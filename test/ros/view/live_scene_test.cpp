#include "spherical_actuator_calibration/ros/view/live_scene.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

LiveScene livePaperScene() {
  CalibrationScene start;
  start.nominal = scenarios::paperNominal();
  return LiveScene(start);
}

msg::ActuatorParameters parametersOf(const Actuator& actuator, const std::string& source) {
  msg::ActuatorParameters message = parametersToRos(actuator);
  message.source = source;
  return message;
}

/// Parameters of which one pole and one coil, both counted from 0, are identified.
msg::ActuatorParameters parametersWith(std::size_t pole, std::size_t coil) {
  ParameterStddevs stddevs;
  stddevs.poles.resize(8);
  stddevs.coils.resize(24);
  stddevs.poles[pole] = {1e-3, 2e-3};
  stddevs.coils[coil] = {4e-3, 1e-3};
  return parametersToRos(scenarios::paperTruth(), stddevs);
}

msg::CalibrationReport reportOf(std::uint32_t sample, double standardized, bool rejected) {
  CycleReport report;
  report.residuals.push_back({sample, Quantity::kTorque, 1e-3, standardized, rejected, ""});
  return reportToRos(report, {});
}

msg::CalibrationSample sampleOf(std::uint32_t id) {
  msg::CalibrationSample sample;
  sample.id = id;
  sample.has_orientation = 1;
  sample.orientation.w = 1.0;
  return sample;
}

TEST(LiveScene, TakesTheParametersInForce) {
  LiveScene scene = livePaperScene();
  const Actuator truth = scenarios::paperTruth();
  scene.receive(parametersOf(truth, "identified"));
  EXPECT_EQ(scene.identified().joints[1].offset, truth.joints[1].offset);
  EXPECT_EQ(scene.scene().identified.poles[3].azimuth, truth.poles[3].azimuth);
  EXPECT_EQ(scene.scene().nominal.poles[3].azimuth, scenarios::paperNominal().poles[3].azimuth);
}

TEST(LiveScene, AnotherDesignChangesNothing) {
  LiveScene scene = livePaperScene();
  Actuator other = scenarios::paperTruth();
  other.coils.pop_back();
  scene.receive(parametersOf(other, "identified"));
  EXPECT_EQ(scene.identified().joints[1].offset, 0.0);
  msg::CoilCurrents currents;
  currents.current.assign(23, 1.0);
  scene.receive(currents);
  EXPECT_EQ(scene.scene().currents.size(), 0);
}

TEST(LiveScene, OnlyIdentifiedAxesHaveAnUncertainty) {
  LiveScene scene = livePaperScene();
  scene.receive(parametersWith(1, 6));
  const CalibrationScene shown = scene.scene();
  EXPECT_NEAR(shown.pole_stddevs.at(1).value_or(0.0), 2e-3, 1e-6);
  EXPECT_FALSE(shown.pole_stddevs.at(0));
  EXPECT_NEAR(shown.coil_stddevs.at(6).value_or(0.0), 4e-3, 1e-6);
  EXPECT_FALSE(shown.coil_stddevs.at(1));
}

TEST(LiveScene, AnAxisWithOneAngleIsNotIdentified) {
  LiveScene scene = livePaperScene();
  ParameterStddevs stddevs;
  stddevs.poles.resize(8);
  stddevs.coils.resize(24);
  stddevs.poles[1].polar = 1e-3;
  scene.receive(parametersToRos(scenarios::paperTruth(), stddevs));
  EXPECT_FALSE(scene.scene().pole_stddevs.at(1));
}

TEST(LiveScene, ReportsLeaveTheUncertainty) {
  LiveScene scene = livePaperScene();
  scene.receive(parametersWith(1, 6));
  scene.receive(reportOf(1, 1.0, false));
  EXPECT_NEAR(scene.scene().coil_stddevs.at(6).value_or(0.0), 4e-3, 1e-6);
}

TEST(LiveScene, NominalParametersHaveNoUncertainty) {
  LiveScene scene = livePaperScene();
  scene.receive(parametersWith(1, 6));
  scene.receive(parametersOf(scenarios::paperNominal(), "nominal"));
  EXPECT_FALSE(scene.scene().pole_stddevs.at(1));
}

TEST(LiveScene, ResidualsOfTheLastReportGoToTheirSamples) {
  LiveScene scene = livePaperScene();
  scene.receive(sampleOf(3));
  scene.receive(sampleOf(4));
  scene.receive(reportOf(4, 3.5, true));
  auto samples = scene.scene().samples;
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_FALSE(samples[0].standardized);
  EXPECT_EQ(samples[1].standardized.value_or(0.0), 3.5);
  EXPECT_TRUE(samples[1].rejected);
  // Those of earlier parameters are not of these.
  scene.receive(reportOf(3, 0.9, false));
  samples = scene.scene().samples;
  EXPECT_EQ(samples[0].standardized.value_or(0.0), 0.9);
  EXPECT_FALSE(samples[1].standardized);
}

TEST(LiveScene, WindowsOfAMotionAreNoSamples) {
  LiveScene scene = livePaperScene();
  scene.receive(sampleOf(1));
  scene.receive(reportOf(1, 0.9, false));
  CycleReport report;
  report.cycle = Cycle::kMotion;
  report.residuals.push_back({1, Quantity::kTorque, 1e-3, 9.0, true, "misfit"});
  scene.receive(reportToRos(report, {}));
  const auto samples = scene.scene().samples;
  EXPECT_FALSE(samples.at(0).standardized);
  EXPECT_FALSE(samples.at(0).rejected);
}

TEST(LiveScene, TheWorseResidualOfASampleIsShown) {
  LiveScene scene = livePaperScene();
  scene.receive(sampleOf(3));
  CycleReport report;
  report.residuals = {{3, Quantity::kOrientation, 1e-3, 7.0, true, "misfit"},
                      {3, Quantity::kTorque, 1e-3, 0.8, false, ""}};
  scene.receive(reportToRos(report, {}));
  const auto samples = scene.scene().samples;
  EXPECT_EQ(samples.at(0).standardized.value_or(0.0), 7.0);
  EXPECT_TRUE(samples.at(0).rejected);
}

TEST(LiveScene, SamplesWithoutOrientationStandWhereTheirJointsWere) {
  LiveScene scene = livePaperScene();
  msg::CalibrationSample sample = sampleOf(1);
  sample.has_orientation = 0;
  sample.joint_position = {0.3, 0.0, 1.0};
  scene.receive(sample);
  const Eigen::Vector3d direction = scene.scene().samples.at(0).direction_stator;
  EXPECT_NEAR(direction.y(), -std::sin(0.3), 1e-12);
  EXPECT_NEAR(direction.z(), std::cos(0.3), 1e-12);
}

TEST(LiveScene, ChangesAreToldOnceAndSmallCurrentsNot) {
  LiveScene scene = livePaperScene();
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

TEST(LiveScene, TheWantedPoseComesAndGoes) {
  LiveScene scene = livePaperScene();
  scene.takeChange();
  sensor_msgs::JointState message;
  message.position = {0.1, 0.2, 0.3};
  scene.receive(message);
  EXPECT_TRUE(scene.takeChange());
  EXPECT_EQ(scene.scene().wanted_joint_position, Eigen::Vector3d(0.1, 0.2, 0.3));
  scene.receive(message);
  EXPECT_FALSE(scene.takeChange());
  message.position[1] = std::nan("");
  scene.receive(message);
  EXPECT_FALSE(scene.takeChange());
  message.position.clear();
  scene.receive(message);
  EXPECT_TRUE(scene.takeChange());
  EXPECT_FALSE(scene.scene().wanted_joint_position);
}

TEST(LiveScene, OfPosesThatPanelAndEngineToldTheLastCounts) {
  LiveScene scene = livePaperScene();
  sensor_msgs::JointState next;
  next.header.stamp = ros::Time(20.0);
  next.position = {0.1, 0.2, 0.3};
  sensor_msgs::JointState taken_back;
  taken_back.header.stamp = ros::Time(10.0);
  scene.receive(next);
  scene.receive(taken_back);
  EXPECT_TRUE(scene.scene().wanted_joint_position);
  taken_back.header.stamp = ros::Time(30.0);
  scene.receive(taken_back);
  scene.receive(next);
  EXPECT_FALSE(scene.scene().wanted_joint_position);
}

}  // namespace
}  // namespace sac
