#include "panel_model.hpp"

#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

ros::WallTime now() {
  return ros::WallTime(1000.0);
}

PanelModel paperPanel() {
  return PanelModel(scenarios::paperNominal(), "/actuator");
}

msg::ActuatorParameters parametersOf(const std::string& source) {
  msg::ActuatorParameters message = parametersToRos(scenarios::paperTruth());
  message.source = source;
  message.revision = 7;
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

msg::CalibrationReport refinementOf(double orientation_uncertainty, double torque_uncertainty) {
  msg::CalibrationReport report;
  report.cycle = msg::CalibrationReport::REFINE;
  report.success = 1;
  report.orientation_uncertainty = orientation_uncertainty;
  report.torque_uncertainty = torque_uncertainty;
  report.error_history = {0.02, 0.001};
  report.estimates.resize(2);
  report.estimates[0].name = "joint_1/offset";
  report.estimates[0].value = 0.01234;
  report.estimates[0].stddev = 1.5e-4;
  report.estimates[0].observable = 1;
  report.estimates[1].name = "coil_3/polar";
  report.estimates[1].stddev = std::numeric_limits<double>::infinity();
  report.estimates[1].observable = 0;
  return report;
}

TEST(PanelModel, TellsTheHealthOfTheStreamsOfItsNamespaceOnly) {
  PanelModel panel = paperPanel();
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
  PanelModel panel = paperPanel();
  panel.receive(diagnosticsOf("actuator/calibration: joint_states", 0, "good"), now());
  panel.receive(diagnosticsOf("actuator/coil_driver: output", 1, "tripped"), now());
  const ros::WallTime later = now() + ros::WallDuration(10.0);
  EXPECT_EQ(panel.streams(later)[0].level, HealthLine::Level::kUnknown);
  EXPECT_TRUE(panel.troubles(later).empty());
}

TEST(PanelModel, TellsTheMostSeriousTroubleFirst) {
  PanelModel panel = paperPanel();
  panel.receive(diagnosticsOf("actuator/a: output", 1, "warm"), now());
  panel.receive(diagnosticsOf("actuator/b: link", 2, "lost"), now());
  panel.receive(diagnosticsOf("actuator/c: link", 0, "good"), now());
  const auto troubles = panel.troubles(now());
  ASSERT_EQ(troubles.size(), 2U);
  EXPECT_EQ(troubles[0].message, "lost");
  EXPECT_EQ(troubles[1].name, "a: output");
}

TEST(PanelModel, ShowsWhatIsSampledAndWhatIsMissing) {
  PanelModel panel = paperPanel();
  msg::CalibrationStatus status;
  status.orientation_samples = 4;
  status.torque_samples.assign(24, 0U);
  status.torque_samples[4] = 2;
  status.coil_done.assign(24, 0);
  status.coil_done[4] = 1;
  status.joint_done = 1;
  panel.receive(status);
  // Coil 1 at azimuth 0 sees pole 1 on the equator there, and no other at this orientation.
  msg::CalibrationSample sample;
  sample.id = 1;
  sample.has_torque = 1;
  sample.orientation.w = 1.0;
  sample.current.assign(24, 0.0);
  sample.current[0] = 2.0;
  panel.receive(sample);
  const auto groups = panel.coverage();
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].bars[0].count, 4U);
  EXPECT_TRUE(groups[0].bars[0].done);
  ASSERT_EQ(groups[1].bars.size(), 8U);
  EXPECT_EQ(groups[1].bars[0].count, 1U);
  EXPECT_EQ(groups[1].bars[4].count, 0U);
  ASSERT_EQ(groups[2].bars.size(), 24U);
  EXPECT_EQ(groups[2].bars[4].count, 2U);
  EXPECT_TRUE(groups[2].bars[4].done);
  EXPECT_FALSE(groups[2].bars[5].done);
}

TEST(PanelModel, SamplesThatCannotBeAreLeftOut) {
  PanelModel panel = paperPanel();
  msg::CalibrationSample sample;
  sample.id = 1;
  sample.has_torque = 1;
  sample.has_orientation = 1;
  sample.orientation.w = 0.5;
  sample.current.assign(24, 2.0);
  panel.receive(sample);
  sample.id = 2;
  sample.orientation.w = 1.0;
  sample.current.assign(30, 2.0);
  panel.receive(sample);
  EXPECT_EQ(panel.coverage()[1].bars[0].count, 0U);
}

TEST(PanelModel, AJointWithoutTorqueModelHasNoPolesAndCoils) {
  Actuator joint_only = scenarios::paperNominal();
  joint_only.poles.clear();
  joint_only.coils.clear();
  joint_only.torque_curve.reset();
  const PanelModel panel(joint_only, "actuator");
  EXPECT_EQ(panel.coverage().size(), 1U);
}

TEST(PanelModel, JudgesByTheUncertaintyOverTheWorkspace) {
  PanelModel panel = paperPanel();
  EXPECT_EQ(panel.verdict(), "Not calibrated.");
  panel.receive(parametersOf("identified"));
  panel.receive(refinementOf(3e-4, 1e-4));
  EXPECT_EQ(panel.verdict().substr(0, 34), "Orientation known to 0.3 mrad, tor");
  EXPECT_NE(panel.verdict().find(": good."), std::string::npos);
  EXPECT_NE(panel.verdict().find("1 of 2 parameters are not identified"), std::string::npos);
  panel.receive(refinementOf(3e-3, 1e-4));
  EXPECT_NE(panel.verdict().find(": fair."), std::string::npos);
  panel.receive(refinementOf(3e-4, 1e-1));
  EXPECT_NE(panel.verdict().find(": poor."), std::string::npos);
}

TEST(PanelModel, NoParameterWithoutItsUncertainty) {
  PanelModel panel = paperPanel();
  panel.receive(parametersOf("identified"));
  panel.receive(refinementOf(3e-4, 1e-4));
  const auto lines = panel.parameters();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].value, "0.01234 rad");
  EXPECT_EQ(lines[0].uncertainty, "± 0.150 mrad");
  EXPECT_EQ(lines[1].value, "–");
  EXPECT_EQ(lines[1].uncertainty, "not identified");
}

TEST(PanelModel, NominalAndRestoredParametersHaveNoUncertaintyToShow) {
  for (const std::string source : {"nominal", "restored"}) {
    PanelModel panel = paperPanel();
    panel.receive(refinementOf(3e-4, 1e-4));
    panel.receive(parametersOf(source));
    // The last report is latched: it may come after the parameters that replaced its own.
    panel.receive(refinementOf(3e-4, 1e-4));
    EXPECT_TRUE(panel.parameters().empty()) << source;
    EXPECT_EQ(panel.verdict().find("known"), std::string::npos) << source;
    EXPECT_EQ(panel.revision(), "revision 7, " + source);
  }
}

TEST(PanelModel, AFailedCycleShowsItsHistoryButNoParameters) {
  PanelModel panel = paperPanel();
  msg::CalibrationReport failed = refinementOf(1.0, 1.0);
  failed.success = 0;
  panel.receive(failed);
  EXPECT_TRUE(panel.parameters().empty());
  EXPECT_EQ(panel.errorHistory(), (std::vector<double>{20.0, 1.0}));
  EXPECT_EQ(panel.historyTitle(), "Refinement: torque error [mN·m]");
}

TEST(PanelModel, ARefinementOfOrientationsAndTorquesHasNoUnit) {
  PanelModel panel = paperPanel();
  msg::CalibrationStatus status;
  status.orientation_samples = 3;
  panel.receive(status);
  panel.receive(refinementOf(3e-4, 1e-4));
  EXPECT_EQ(panel.errorHistory(), (std::vector<double>{0.02, 0.001}));
  EXPECT_EQ(panel.historyTitle(), "Refinement: standardised residuals [1]");
}

}  // namespace
}  // namespace sac
