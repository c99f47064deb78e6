#include "spherical_actuator_calibration/assessment/report_file.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/calibration/cycle_title.hpp"
#include "support/scenarios.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

CalibrationSession calibratedSession(int hold_out_every) {
  scenarios::Generator generator(6);
  CalibrationConfig config;
  config.hold_out_every = hold_out_every;
  CalibrationSession session(
      {scenarios::paperNominal()},
      scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator),
      config);
  for (const CycleRequest& request : {CycleRequest{Cycle::kJoint}, CycleRequest{Cycle::kRefine}}) {
    session.run(request);
  }
  return session;
}

std::string reportOf(const CalibrationSession& session) {
  return renderReport(session, {"2024-05-31T12:00:00Z", {}, "0.1.0", 7U}, {});
}

/// Lines of the block that a key of the report opens.
std::vector<std::string> blockOf(const std::string& report, const std::string& key) {
  std::istringstream stream(report);
  std::vector<std::string> lines;
  bool is_inside = false;
  for (std::string line; std::getline(stream, line);) {
    const auto depth = line.find_first_not_of(' ');
    if (depth == 2) {
      is_inside = line == "  " + key + ":";
    } else if (is_inside) {
      lines.push_back(line.substr(depth));
    }
  }
  return lines;
}

bool anyHolds(const std::vector<std::string>& lines, const std::string& part) {
  return std::any_of(lines.begin(), lines.end(), [&part](const std::string& line) {
    return line.find(part) != std::string::npos;
  });
}

/// Keys of a node and of all below it; `configuration` has a file of its own that explains it.
void collectKeys(const YAML::Node& node, std::set<std::string>& keys) {
  for (const auto& entry : node) {
    if (!node.IsMap()) {
      collectKeys(entry, keys);
      continue;
    }
    const auto key = entry.first.as<std::string>();
    keys.insert(key);
    if (key != "configuration") {
      collectKeys(entry.second, keys);
    }
  }
}

TEST(ReportFile, HasNoKeyThatItsPageDoesNotExplain) {
  std::ostringstream page;
  page << std::ifstream(SOURCE_DIR "/doc/report.md").rdbuf();
  const CalibrationSession session = calibratedSession(6);
  const std::string report = renderReport(session,
                                          {"2024-05-31T12:00:00Z", {{"a.bag", "00"}}, "0.2.0", 7U},
                                          {},
                                          {{"tracker_inverted", "It is inverted.", 9.0}});
  std::set<std::string> keys;
  collectKeys(YAML::Load(report), keys);
  ASSERT_GT(keys.size(), 60U);
  for (const std::string& key : keys) {
    EXPECT_NE(page.str().find("`" + key + "`"), std::string::npos) << key;
  }
}

TEST(ReportFile, TellsVerdictRevisionAndNextSteps) {
  const std::string report = reportOf(calibratedSession(0));
  EXPECT_NE(report.find("  revision: 7\n"), std::string::npos);
  EXPECT_NE(report.find("  verdict: {grade: not_validated, sound: true, sentence: "),
            std::string::npos);
  EXPECT_TRUE(anyHolds(blockOf(report, "next_steps"), "Hold out samples"));
  EXPECT_TRUE(blockOf(report, "validation").empty());
}

TEST(ReportFile, TellsItsGradeAlone) {
  const TemporaryFolder folder;
  const std::string path = folder.path("report.yaml");
  EXPECT_EQ(gradeInReport(path), "");
  folder.write("report.yaml", reportOf(calibratedSession(0)));
  EXPECT_EQ(gradeInReport(path), gradeName(Grade::kNotValidated));
  folder.write("report.yaml", "calibration_report:\n  verdict: 1\n");
  EXPECT_EQ(gradeInReport(path), "");
}

TEST(ReportFile, NamesEverySampleWithItsPoseAndCoils) {
  const CalibrationSession session = calibratedSession(0);
  const std::vector<std::string> lines = blockOf(reportOf(session), "samples");
  ASSERT_EQ(lines.size(), session.samples().size());
  EXPECT_EQ(lines[0].find("- {id: 1, joint_position: ["), 0U) << lines[0];
  EXPECT_NE(lines[0].find("torque: false, coils: [], validation: false}"), std::string::npos);
  EXPECT_NE(lines[10].find("orientation: true, torque: true, coils: [1]"), std::string::npos)
      << lines[10];
}

TEST(ReportFile, CallsEachCycleByATitle) {
  const YAML::Node report = YAML::Load(reportOf(calibratedSession(0)))["calibration_report"];
  EXPECT_EQ(report["cycles"][0]["title"].as<std::string>(), "Joint");
  EXPECT_EQ(report["cycles"][1]["title_of_kind"].as<std::string>(), "Refinement");
  EXPECT_EQ(cycleTitle(Cycle::kPoles, 0), "Poles with coil 1");
  EXPECT_EQ(cyclesTitle(Cycle::kPoles), "Poles with their coil");
  EXPECT_EQ(cycleTitle(Cycle::kCoil, 2), "Coil 3");
}

TEST(ReportFile, TellsToWhatEachParameterBelongs) {
  const CalibrationSession session = calibratedSession(0);
  const YAML::Node report = YAML::Load(reportOf(session))["calibration_report"];
  const auto poles = static_cast<std::size_t>(session.model().space().pole(0));
  const auto coils = static_cast<std::size_t>(session.model().space().coil(0));
  const YAML::Node parameters = report["parameters"];
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    EXPECT_EQ(parameters[p]["kind"].as<std::string>(),
              p < poles   ? "joint"
              : p < coils ? "pole"
                          : "coil")
        << parameters[p]["name"];
  }
}

TEST(ReportFile, ShowsTheResidualsOfHeldOutSamples) {
  const CalibrationSession session = calibratedSession(6);
  const std::vector<std::string> lines = blockOf(reportOf(session), "validation");
  ASSERT_TRUE(session.validation());
  EXPECT_TRUE(anyHolds(lines, "they agree with the parameters"));
  const auto residuals = std::find(lines.begin(), lines.end(), "residuals:");
  EXPECT_EQ(static_cast<std::size_t>(lines.end() - residuals),
            session.validation()->residuals.size() + 1);
}

TEST(ReportFile, MapsUncertaintyOverTheWorkspaceAndCountsCoverage) {
  const CalibrationSession session = calibratedSession(0);
  const std::string report = reportOf(session);
  const std::vector<std::string> workspace = blockOf(report, "workspace");
  ASSERT_EQ(workspace.size(), 1U + 2U * (1U + 13U));
  EXPECT_EQ(workspace[0].find("tilt: [-0.6"), 0U) << workspace[0];
  const std::vector<std::string> coverage = blockOf(report, "coverage");
  EXPECT_TRUE(anyHolds(coverage, "- {name: joint_3, lowest: -"));
  EXPECT_TRUE(anyHolds(coverage, "coils: [30, 4, 4"));
}

TEST(ReportFile, HasNoTorqueFiguresWithoutTorqueModel) {
  Actuator joint_only = scenarios::paperNominal();
  joint_only.poles.clear();
  joint_only.coils.clear();
  joint_only.torque_curve.reset();
  const CalibrationSession session({joint_only}, {}, {});
  const std::string report = reportOf(session);
  EXPECT_NE(report.find("    torque: []\n"), std::string::npos);
  EXPECT_NE(report.find("    poles: []\n"), std::string::npos);
  EXPECT_NE(report.find("{grade: failed, "), std::string::npos);
}

}  // namespace
}  // namespace sac
