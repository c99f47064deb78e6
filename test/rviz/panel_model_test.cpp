#include "panel_model.hpp"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

ros::WallTime now() {
  return ros::WallTime(1000.0);
}

/// A joint whose first offset and first axis are identified, a pole, and a coil with a gain.
msg::ActuatorParameters parameters() {
  msg::ActuatorParameters message;
  message.source = "identified";
  message.revision = 7;
  message.has_joints = 1;
  for (auto& joint : message.joints) {
    joint.offset_stddev = kUnknown;
    joint.axis_stddev = {kUnknown, kUnknown};
  }
  message.joints[0].axis.x = 1.0;
  message.joints[0].offset = 0.01234;
  message.joints[0].offset_stddev = 1.5e-4;
  message.joints[0].axis_stddev = {1e-4, 2e-4};
  message.poles.resize(1);
  message.poles[0].polar = 0.25;
  message.poles[0].polar_stddev = 3e-5;
  message.poles[0].azimuth_stddev = kUnknown;
  message.poles[0].gain_stddev = kUnknown;
  message.coils.resize(1);
  message.coils[0].gain = 1.05;
  message.coils[0].gain_stddev = 2e-3;
  return message;
}

msg::CalibrationReport report(const std::string& unit) {
  msg::CalibrationReport message;
  message.cycle = msg::CalibrationReport::REFINE;
  message.error_unit = unit;
  message.error_history = {0.02, 0.001};
  message.estimates.resize(2);
  message.estimates[0].name = "torque_bias/x";
  message.estimates[0].unit = "N·m";
  message.estimates[0].value = 0.01234;
  message.estimates[0].stddev = 1.5e-4;
  message.estimates[1].name = "coil_3/polar";
  message.estimates[1].unit = "rad";
  message.estimates[1].stddev = kUnknown;
  return message;
}

diagnostic_msgs::DiagnosticArray diagnosticsOf(const std::string& name,
                                               std::uint8_t level,
                                               const std::string& text) {
  diagnostic_msgs::DiagnosticArray array;
  array.status.resize(1);
  array.status[0].name = name;
  array.status[0].level = static_cast<std::int8_t>(level);
  array.status[0].message = text;
  return array;
}

TEST(PanelModel, TellsTheHealthOfTheStreamsOfItsNamespaceOnly) {
  PanelModel panel("/actuator");
  panel.receive(diagnosticsOf("actuator/calibration: joint_states", 0, "good"), now());
  panel.receive(diagnosticsOf("actuator/calibration: measured_torque", 2, "silent"), now());
  panel.receive(diagnosticsOf("other/calibration: coil_currents", 0, "good"), now());
  const auto streams = panel.streams(now());
  ASSERT_EQ(streams.size(), 4U);
  EXPECT_EQ(streams[0].level, HealthLine::Level::kGood);
  EXPECT_EQ(streams[1].level, HealthLine::Level::kUnknown);
  EXPECT_EQ(streams[3].level, HealthLine::Level::kError);
  EXPECT_EQ(streams[3].message, "silent");
}

TEST(PanelModel, OldHealthIsUnknown) {
  PanelModel panel("/actuator");
  panel.receive(diagnosticsOf("actuator/calibration: joint_states", 0, "good"), now());
  panel.receive(diagnosticsOf("actuator/coil_driver: output", 1, "tripped"), now());
  const ros::WallTime later = now() + ros::WallDuration(10.0);
  EXPECT_EQ(panel.streams(later)[0].level, HealthLine::Level::kUnknown);
  EXPECT_TRUE(panel.troubles(later).empty());
}

TEST(PanelModel, TellsTheMostSeriousTroubleFirst) {
  PanelModel panel("/actuator");
  panel.receive(diagnosticsOf("actuator/a: output", 1, "warm"), now());
  panel.receive(diagnosticsOf("actuator/b: link", 2, "lost"), now());
  panel.receive(diagnosticsOf("actuator/c: link", 0, "good"), now());
  const auto troubles = panel.troubles(now());
  ASSERT_EQ(troubles.size(), 2U);
  EXPECT_EQ(troubles[0].message, "lost");
  EXPECT_EQ(troubles[1].name, "a: output");
}

TEST(PanelModel, ShowsTheCoverageThatItIsTold) {
  PanelModel panel("/actuator");
  msg::CalibrationStatus status;
  status.joint.samples = 4;
  status.joint.identified = 1;
  status.poles.resize(8);
  status.poles[0].samples = 1;
  status.poles[0].wanted = 3;
  status.coils.resize(24);
  status.coils[4].samples = 5;
  status.coils[4].seen_well = 1;
  panel.receive(status);
  const auto groups = panel.coverage();
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].bars[0].coverage.samples, 4U);
  EXPECT_TRUE(groups[0].bars[0].coverage.identified);
  ASSERT_EQ(groups[1].bars.size(), 8U);
  EXPECT_EQ(groups[1].bars[0].name, "pole_1");
  EXPECT_EQ(groups[1].bars[0].coverage.wanted, 3U);
  ASSERT_EQ(groups[2].bars.size(), 24U);
  EXPECT_EQ(groups[2].bars[4].name, "coil_5");
  EXPECT_TRUE(groups[2].bars[4].coverage.seen_well);
  EXPECT_EQ(panel.coils(), 24U);
}

TEST(PanelModel, AJointWithoutTorqueModelHasNoPolesAndCoils) {
  PanelModel panel("actuator");
  panel.receive(msg::CalibrationStatus());
  EXPECT_EQ(panel.coverage().size(), 1U);
}

TEST(PanelModel, ARotorWithoutJointsHasNothingOfThem) {
  PanelModel panel("/actuator");
  EXPECT_TRUE(panel.hasJoints());
  EXPECT_EQ(panel.whyNoJointCycle(), "");
  msg::ActuatorParameters levitated = parameters();
  levitated.has_joints = 0;
  levitated.joints = {};
  panel.receive(levitated);
  EXPECT_FALSE(panel.hasJoints());
  EXPECT_NE(panel.whyNoJointCycle().find("The rotor has no joints: "), std::string::npos);
  ASSERT_EQ(panel.streams(now()).size(), 3U);
  EXPECT_EQ(panel.streams(now())[0].name, "coil_currents");
  EXPECT_TRUE(panel.coverage().empty());
  EXPECT_EQ(panel.parameters().front().name, "pole_1/polar");
}

TEST(PanelModel, ShowsTheGradeThatItIsTold) {
  PanelModel panel("/actuator");
  EXPECT_EQ(panel.grade(), "");
  EXPECT_EQ(panel.nextStep(), "Waiting for the calibration node.");
  msg::CalibrationStatus status;
  status.grade = msg::CalibrationReport::NOT_VALIDATED;
  status.grade_reason = "Nothing judges it.";
  status.next_step = "Capture.";
  panel.receive(status);
  EXPECT_EQ(panel.grade(), "Grade: not_validated.");
  EXPECT_EQ(panel.gradeReason(), "Nothing judges it.");
  EXPECT_EQ(panel.nextStep(), "Capture.");
}

TEST(PanelModel, ShowsTheParametersInForceWithTheirUncertainty) {
  PanelModel panel("/actuator");
  EXPECT_TRUE(panel.parameters().empty());
  EXPECT_EQ(panel.revision(), "no parameters yet");
  panel.receive(parameters());
  EXPECT_EQ(panel.revision(), "revision 7, identified");
  const auto lines = panel.parameters();
  ASSERT_EQ(lines.size(), 6U + 2U + 3U);
  EXPECT_EQ(lines[0].name, "joint_1/offset");
  EXPECT_EQ(lines[0].value, "0.01234 rad");
  EXPECT_EQ(lines[0].uncertainty, "± 0.150 mrad");
  EXPECT_EQ(lines[1].value, "1.0000, 0.0000, 0.0000");
  EXPECT_EQ(lines[1].uncertainty, "± 0.200 mrad");
  EXPECT_EQ(lines[6].value, "0.25000 rad");
  EXPECT_EQ(lines.back().name, "coil_1/gain");
  EXPECT_EQ(lines.back().value, "1.05000");
  EXPECT_EQ(lines.back().uncertainty, "± 0.002");
}

TEST(PanelModel, WhatIsNotIdentifiedHasNoValueToShow) {
  PanelModel panel("/actuator");
  panel.receive(parameters());
  const auto lines = panel.parameters();
  for (const std::size_t place : {2U, 3U, 7U}) {
    EXPECT_EQ(lines[place].value, "–") << lines[place].name;
    EXPECT_EQ(lines[place].uncertainty, "not identified") << lines[place].name;
  }
}

TEST(PanelModel, EstimatesHaveTheUnitThatTheReportTells) {
  PanelModel panel("/actuator");
  panel.receive(report("1"));
  const auto lines = panel.estimates();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].value, "0.01234 N·m");
  EXPECT_EQ(lines[0].uncertainty, "± 0.150 mN·m");
  EXPECT_EQ(lines[1].uncertainty, "not identified");
}

TEST(PanelModel, NoPrefixStandsBeforeAUnitThatWouldTakeItOtherwise) {
  msg::CalibrationReport message = report("1");
  message.estimates[0].unit = "s²";
  message.estimates[0].value = 1.234e-6;
  message.estimates[0].stddev = 1.5e-8;
  message.estimates[1].unit = "kg·m²";
  message.estimates[1].value = 2.5e-3;
  message.estimates[1].stddev = 1e-5;
  PanelModel panel("/actuator");
  panel.receive(message);
  const auto lines = panel.estimates();
  EXPECT_EQ(lines[0].value, "1.234e-06 s²");
  EXPECT_EQ(lines[0].uncertainty, "± 1.5e-08 s²");
  EXPECT_EQ(lines[1].value, "0.0025 kg·m²");
  EXPECT_EQ(lines[1].uncertainty, "± 1e-05 kg·m²");
}

TEST(PanelModel, TheHistoryHasTheUnitThatTheReportTells) {
  PanelModel panel("/actuator");
  EXPECT_EQ(panel.historyTitle(), "No cycle has run");
  panel.receive(report("N·m"));
  EXPECT_EQ(panel.errorHistory(), (std::vector<double>{20.0, 1.0}));
  EXPECT_EQ(panel.historyTitle(), "Cycle refine: error [mN·m]");
  panel.receive(report("1"));
  EXPECT_EQ(panel.errorHistory(), (std::vector<double>{0.02, 0.001}));
  EXPECT_EQ(panel.historyTitle(), "Cycle refine: error [1]");
}

TEST(PanelModel, SamplesAreListedWorstFirstUntilTheyAreRemoved) {
  msg::CalibrationReport message = report("rad");
  message.residuals.resize(3);
  const double standardized[] = {0.8, 9.5, 2.0};
  for (std::size_t n = 0; n < 3; ++n) {
    message.residuals[n].id = static_cast<std::uint32_t>(n + 1);
    message.residuals[n].unit = n == 0 ? "rad" : "N·m";
    message.residuals[n].quantity = n == 0 ? "orientation" : n == 1 ? "torque" : "force";
    message.residuals[n].residual = 0.0015;
    message.residuals[n].standardized = standardized[n];
  }
  message.residuals[1].rejected = 1;
  message.residuals[1].reason = "contradicts the others";
  PanelModel panel("actuator");
  panel.receive(message);
  ASSERT_EQ(panel.samples().size(), 3U);
  const SampleLine expected = {2, "torque", "", "1.500 mN·m", "9.5", "contradicts the others"};
  EXPECT_EQ(panel.samples()[0], expected);
  EXPECT_EQ(panel.samples()[2].quantity, "orientation");
  EXPECT_EQ(panel.samples()[2].verdict, "");
}

msg::CalibrationSample torqueSample(std::uint32_t id, std::vector<double> current) {
  msg::CalibrationSample sample;
  sample.id = id;
  sample.current = std::move(current);
  return sample;
}

/// Of a calibration of three coils, with a report of one torque.
PanelModel panelWithReportOfSample(std::uint32_t id, const std::string& cycle) {
  PanelModel panel("actuator");
  msg::CalibrationStatus status;
  status.current_threshold = 0.1;
  status.coils.resize(3);
  panel.receive(status);
  msg::CalibrationReport message = report("rad");
  message.cycle = cycle;
  message.residuals.resize(1);
  message.residuals[0].id = id;
  message.residuals[0].quantity = "torque";
  panel.receive(message);
  return panel;
}

TEST(PanelModel, TellsWhereSamplesWereTakenOnceItHasHeardOfThem) {
  PanelModel panel = panelWithReportOfSample(7, msg::CalibrationReport::REFINE);
  EXPECT_EQ(panel.samples()[0].quantity, "torque");
  EXPECT_EQ(panel.samples()[0].angles, "");
  EXPECT_TRUE(panel.takeRequestForSamples());
  EXPECT_FALSE(panel.takeRequestForSamples()) << "it is asked for once";
  panel.repeatRequestForSamples();
  EXPECT_TRUE(panel.takeRequestForSamples());
  panel.receive(std::vector<msg::CalibrationSample>{torqueSample(7, {0.0, 0.01, -2.0})});
  ASSERT_EQ(panel.samples().size(), 1U);
  EXPECT_EQ(panel.samples()[0].quantity, "torque, coil 3");
  EXPECT_EQ(panel.samples()[0].angles, "+0.0°, +0.0°, +0.0°");
}

TEST(PanelModel, ListsSamplesThatNoCycleHasConsideredToo) {
  PanelModel panel = panelWithReportOfSample(7, msg::CalibrationReport::REFINE);
  panel.receive(torqueSample(8, {0.0, 0.0, 0.0}));
  panel.receive(torqueSample(7, {2.0, 0.0, 0.0}));
  msg::CalibrationSample held_out = torqueSample(9, {0.0, 2.0, 0.0});
  held_out.validation = 1;
  panel.receive(held_out);
  const std::vector<SampleLine> lines = panel.samples();
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].id, 7U);
  const SampleLine expected = {
      8, "orientation", "+0.0°, +0.0°, +0.0°", "–", "–", "not in the last cycle"};
  EXPECT_EQ(lines[1], expected);
  EXPECT_EQ(lines[2].quantity, "torque, coil 2");
  EXPECT_EQ(lines[2].verdict, "held out");
}

TEST(PanelModel, TakesWindowsOfAMotionForNoSamples) {
  PanelModel panel = panelWithReportOfSample(7, msg::CalibrationReport::MOTION);
  panel.receive(torqueSample(7, {2.0, 0.0, 0.0}));
  ASSERT_EQ(panel.samples().size(), 1U);
  EXPECT_EQ(panel.samples()[0].angles, "");
  EXPECT_EQ(panel.samples()[0].quantity, "torque");
}

}  // namespace
}  // namespace sac
