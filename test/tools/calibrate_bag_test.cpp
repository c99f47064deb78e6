#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/urdf_file.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/version.hpp"
#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "support/bag_editing.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"
#include "tools/program_outcome.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

constexpr char kPositioner[] = SOURCE_DIR "/config/examples/two_axis_positioner/actuator.yaml";

/// The paper's actuator with three of its coils, so that a session is short.
Actuator nominalUnit() {
  Actuator actuator = loadActuator(SOURCE_DIR "/config/pm_spherical_8x24.yaml");
  actuator.coils.resize(3);
  return actuator;
}

/// Runs the program on an emulated session of a unit with manufacturing errors.
class CalibrateBag : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared = new TemporaryFolder;
    saveDescription(actuator(), {nominalUnit()}, OverwritePolicy::kRefuse);
    saveDescription(truth(), {trueUnit()}, OverwritePolicy::kRefuse);
    record(session(), {});
  }
  static void TearDownTestSuite() {
    delete shared;
    shared = nullptr;
  }

  static void record(const std::string& bag,
                     const SimulationOptions& simulation,
                     const CalibratedDescription& described = {nominalUnit()}) {
    SessionPlanOptions plan_options;
    plan_options.validation_poses = 0;
    SessionBagOptions options;
    options.registration = simulation.registration;
    options.begin = simulation.begin;
    SessionBagWriter writer(bag, described, options);
    simulateSession(trueUnit(), planSession(nominalUnit(), plan_options, 1), simulation, writer);
    writer.close();
  }

  static Actuator trueUnit() { return manufacturedActuator(nominalUnit(), {}, 5); }
  static std::string session() { return shared->path("session.bag"); }
  static std::string actuator() { return shared->path("actuator.yaml"); }
  static std::string truth() { return shared->path("truth.yaml"); }
  std::string path(const std::string& name) const { return folder_.path(name); }
  std::string output() const { return path("calibrated.yaml"); }

  Outcome run(const std::string& arguments) const {
    return outcomeOf(std::string(CALIBRATE_BAG) + " " + arguments, folder_);
  }

  /// Calibrates the emulated session into output().
  Outcome calibrate(const std::string& options) const {
    return run("--actuator " + actuator() + " --output " + output() + " " + options + " " +
               session());
  }

  /// Bad usage or input: status 2, one sentence that holds `part`, nothing written.
  void expectRefusal(const std::string& arguments, const std::string& part) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(outcome.errors.find("calibrate_bag: "), 0U) << outcome.errors;
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_FALSE(fs::exists(output()));
  }

  TemporaryFolder folder_;

 private:
  static TemporaryFolder* shared;
};

TemporaryFolder* CalibrateBag::shared = nullptr;

TEST_F(CalibrateBag, FindsTheTruthOfAnEmulatedSession) {
  const Outcome outcome = calibrate("--truth " + truth());
  ASSERT_EQ(outcome.status, 0) << outcome.output << outcome.errors;
  EXPECT_EQ(outcome.errors, "");

  const CalibratedDescription result = loadDescription(output());
  const ParameterSpace space(nominalUnit());
  const Eigen::VectorXd error =
      space.coordinatesOf(result.actuator) - space.coordinatesOf(trueUnit());
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(result.stddevs.poles.at(7).azimuth.value(), 5e-4);
  EXPECT_LT(result.stddevs.coils.at(2).polar.value(), 5e-4);
  ASSERT_EQ(result.calibration->cycles.size(), 5U);
  EXPECT_EQ(result.calibration->cycles[3].coil, 2U);
  EXPECT_EQ(result.calibration->cycles[4].cycle, "refine");
  EXPECT_TRUE(result.calibration->unidentified.empty());

  std::smatch covered;
  ASSERT_TRUE(std::regex_search(
      outcome.output, covered, std::regex("holds the truth for (\\d+) of (\\d+) identified")));
  EXPECT_EQ(covered[2], "31");
  EXPECT_GE(std::stoi(covered[1]), 24);
}

TEST_F(CalibrateBag, TruthMayCountItsAzimuthsFromAnotherTurn) {
  Actuator turned = trueUnit();
  turned.poles[1].azimuth += 2.0 * kPi;
  turned.coils[0].azimuth -= 2.0 * kPi;
  saveDescription(path("turned.yaml"), {turned}, OverwritePolicy::kRefuse);
  const auto table = [](const Outcome& outcome) {
    return outcome.output.substr(outcome.output.find("\nparameter "));
  };
  EXPECT_EQ(table(calibrate("--force --truth " + path("turned.yaml"))),
            table(calibrate("--force --truth " + truth())));
}

TEST_F(CalibrateBag, PrintsWhatAnOperatorWantsToKnow) {
  const std::string text = calibrate("").output;
  for (const std::string part : {"joint_states: ",
                                 "measured_orientation: ",
                                 "measured_torque: ",
                                 "coil_currents: ",
                                 "dwells at rest gave",
                                 "\njoint: Joint calibrated",
                                 "\npoles:1: ",
                                 "\ncoil:2: ",
                                 "mean orientation error [mrad]: ",
                                 "rms torque error [mN.m]: ",
                                 "reduced chi-square",
                                 "condition number",
                                 "\njoint_2/axis_v ",
                                 "\ncoil_3/azimuth "}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(text.find("truth"), std::string::npos);
}

TEST_F(CalibrateBag, RunsTheCyclesAskedFor) {
  const Outcome outcome = calibrate("--cycles joint");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("not identified"), std::string::npos);
  const CalibratedDescription result = loadDescription(output());
  EXPECT_EQ(result.calibration->cycles.size(), 1U);
  EXPECT_EQ(result.actuator.poles[3].azimuth, nominalUnit().poles[3].azimuth);
  EXPECT_FALSE(result.stddevs.poles.at(3).azimuth);
  EXPECT_TRUE(result.stddevs.joints[2].offset);
}

TEST_F(CalibrateBag, RefinementIsBetterThanTheSequence) {
  ASSERT_EQ(calibrate("--cycles joint,poles:1,coils").status, 0);
  const double sequential = *loadDescription(output()).stddevs.poles.at(0).polar;
  ASSERT_EQ(calibrate("--cycles joint,poles:1,coils,refine --force").status, 0);
  EXPECT_LT(*loadDescription(output()).stddevs.poles.at(0).polar, sequential);
}

TEST_F(CalibrateBag, WritesTheOthersWhenACycleFails) {
  const Outcome outcome = calibrate("--cycles coil:2,joint");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("coil:2: FAILED."), std::string::npos) << outcome.output;
  const CalibratedDescription result = loadDescription(output());
  ASSERT_EQ(result.calibration->cycles.size(), 1U);
  EXPECT_EQ(result.calibration->cycles[0].cycle, "joint");
}

TEST_F(CalibrateBag, WritesNothingWhenNoCycleSucceeds) {
  const Outcome outcome = calibrate("--cycles coil:2,poles:9");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("No cycle succeeded"), std::string::npos);
  EXPECT_NE(outcome.output.find("Coil 9 does not exist"), std::string::npos) << outcome.output;
  EXPECT_FALSE(fs::exists(output()));
}

TEST_F(CalibrateBag, RealPositionerMissesTheAxisThatItHasNot) {
  const Outcome outcome = run("--actuator " + std::string(kPositioner) + " --output " + output() +
                              " " + POSITIONER_BAG);
  EXPECT_EQ(outcome.status, 1) << outcome.errors;
  EXPECT_NE(outcome.output.find("Not observable, left as they were: joint_3/axis_u joint_3/axis_v"),
            std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("calibrated from 105 samples"), std::string::npos);
  EXPECT_EQ(outcome.output.find("rejected: "), std::string::npos);
  std::smatch rms;
  ASSERT_TRUE(std::regex_search(outcome.output, rms, std::regex("orientation rms ([0-9.]+) mrad")));
  EXPECT_LE(std::stod(rms[1]), 0.90);
  EXPECT_EQ(loadActuator(output()).joints[2].axis, loadActuator(kPositioner).joints[2].axis);
}

TEST_F(CalibrateBag, TellsWhatOfTheConfigurationHasNoEffectOnSamples) {
  const std::string config =
      folder_.write("config.yaml",
                    "dwell: {rest_window: 0.4}\nmeans: {smallest_count: 12}\n"
                    "currents: {threshold: 0.06}\n");
  const std::string options = "--config " + config + " --output " + output() + " --force ";
  const std::string idle = "dwell.rest_window, means.smallest_count of the configuration";
  const Outcome samples =
      run("--actuator " + std::string(kPositioner) + " " + options + POSITIONER_BAG);
  EXPECT_NE(samples.output.find(idle), std::string::npos) << samples.output;
  const Outcome streams =
      run("--actuator " + actuator() + " --cycles joint --from streams " + options + session());
  EXPECT_EQ(streams.status, 0) << streams.errors;
  EXPECT_EQ(streams.output.find(idle), std::string::npos) << streams.output;
}

TEST_F(CalibrateBag, WithoutTrackerTheRotationOfTheStatorStaysOpen) {
  SimulationOptions simulation;
  simulation.tracker.poses = 0;
  record(path("torques.bag"), simulation);
  const Outcome outcome = run("--actuator " + actuator() + " --truth " + truth() + " --output " +
                              output() + " " + path("torques.bag"));
  EXPECT_EQ(outcome.status, 1) << outcome.errors;
  EXPECT_NE(outcome.output.find("28 of 31 directions identified"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("about stator z"), std::string::npos);
  EXPECT_NE(outcome.output.find("known only relative to each other:"), std::string::npos);
  const CalibratedDescription result = loadDescription(output());
  EXPECT_TRUE(result.stddevs.poles[0].polar);
  const std::vector<std::string>& open = result.calibration->unidentified;
  EXPECT_NE(std::find(open.begin(), open.end(), "coil_1/azimuth"), open.end());
  EXPECT_EQ(std::find(open.begin(), open.end(), "pole_1/azimuth"), open.end());
}

TEST_F(CalibrateBag, WritesTheUrdfFromTheShippedTemplate) {
  const Outcome outcome = calibrate("--urdf " + path("calibrated.urdf"));
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const Actuator result = loadActuator(output());
  const auto joints = readJoints(path("calibrated.urdf"), {"joint_1", "joint_2", "joint_3"});
  for (std::size_t k = 0; k < kJoints; ++k) {
    EXPECT_LT((joints[k].axis - result.joints[k].axis).norm(), 1e-12);
    EXPECT_NEAR(joints[k].offset, result.joints[k].offset, 1e-12);
  }
}

TEST_F(CalibrateBag, WritesAllFiguresForPrograms) {
  ASSERT_EQ(calibrate("--report " + path("made/of/folders")).status, 0);
  const YAML::Node report =
      YAML::LoadFile(path("made/of/folders/report.yaml"))["calibration_report"];
  EXPECT_EQ(report["serial"].as<std::string>(), "unit-001");
  ASSERT_EQ(report["cycles"].size(), 5U);
  const YAML::Node joint = report["cycles"][0];
  EXPECT_EQ(joint["estimates"].size(), 9U);
  EXPECT_EQ(joint["residuals"].size(), joint["samples_used"].as<std::size_t>());
  EXPECT_EQ(joint["error_history"].size(), joint["iterations"].as<std::size_t>() + 1);
  EXPECT_EQ(joint["error_unit"].as<std::string>(), "rad");
  EXPECT_LT(joint["orientation_rms"].as<double>(), 1e-3);
  EXPECT_EQ(report["parameters"].size(), 31U);
  EXPECT_EQ(report["configuration"]["dwell"]["rest_window"].as<double>(), 0.3);
  EXPECT_GE(report["recording"].size(), 5U);
}

TEST_F(CalibrateBag, RecordsWhereACalibrationComesFrom) {
  ASSERT_EQ(calibrate("--cycles joint").status, 0);
  const CalibrationRecord record = *loadDescription(output()).calibration;
  ASSERT_EQ(record.source.size(), 1U);
  EXPECT_EQ(record.source[0].recording, "session.bag");
  ASSERT_EQ(std::system(("sha256sum " + session() + " >" + path("sum")).c_str()), 0);
  EXPECT_EQ(record.source[0].checksum, "sha256:" + contentOf(path("sum")).substr(0, 64));
  EXPECT_EQ(record.software, packageVersion());
  EXPECT_TRUE(std::regex_match(record.date, std::regex(R"(20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ)")));
}

TEST_F(CalibrateBag, TheSameRecordingGivesTheSameBytes) {
  const std::string options = "--date 2024-05-31T12:00:00Z --force";
  ASSERT_EQ(calibrate(options).status, 0);
  const std::string first = contentOf(output());
  ASSERT_EQ(calibrate(options).status, 0);
  EXPECT_EQ(contentOf(output()), first);
  EXPECT_NE(first.find("2024-05-31T12:00:00Z"), std::string::npos);
}

TEST_F(CalibrateBag, ValidatesWithHeldOutSamples) {
  const std::string config = folder_.write("config.yaml", "validation: {hold_out_every: 6}\n");
  const Outcome outcome = calibrate("--config " + config);
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("held-out samples: orientation rms"), std::string::npos);
  const CalibrationRecord record = *loadDescription(output()).calibration;
  ASSERT_TRUE(record.validation);
  EXPECT_GE(record.validation->samples, 5U);
  EXPECT_LT(record.validation->orientation_rms.value(), 1e-3);
  EXPECT_LT(record.validation->torque_rms.value(), 1e-2);
}

TEST_F(CalibrateBag, JudgesACalibrationAndNoDrawing) {
  expectRefusal("--check " + session(), "the recorded description is a drawing");
  expectRefusal("--check --actuator " + actuator() + " " + session(), actuator() + " is a drawing");
  ASSERT_EQ(calibrate("").status, 0);
  EXPECT_EQ(run("--check --actuator " + output() + " " + session()).status, 0);
  record(path("again.bag"), {}, loadDescription(output()));
  EXPECT_EQ(run("--check " + path("again.bag")).status, 0);
}

TEST_F(CalibrateBag, TellsWhenNoSampleWasFound) {
  const std::string config = folder_.write("config.yaml", "means: {smallest_duration: 60.0}\n");
  const Outcome outcome = calibrate("--config " + config);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("No sample was found"), std::string::npos) << outcome.output;
  EXPECT_FALSE(fs::exists(output()));
}

TEST_F(CalibrateBag, ReplacesFilesOnlyWhenForced) {
  folder_.write("calibrated.yaml", "precious");
  const Outcome refused = calibrate("--cycles joint");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.errors.find("exists already"), std::string::npos);
  EXPECT_EQ(refused.output, "") << "refused before the recording is read";
  EXPECT_EQ(contentOf(output()), "precious");
  EXPECT_EQ(calibrate("--cycles joint --force").status, 0);
  EXPECT_NE(contentOf(output()), "precious");
}

TEST_F(CalibrateBag, HelpTellsEveryOption) {
  const Outcome outcome = run("--help");
  EXPECT_EQ(outcome.status, 0);
  std::istringstream words(
      "--actuator --check --config --ns --from --cycles --output --urdf --urdf-template --report "
      "--truth --date --force Exit");
  for (std::string word; words >> word;) {
    EXPECT_NE(outcome.output.find(word), std::string::npos) << word;
  }
}

TEST_F(CalibrateBag, RefusesBadUsage) {
  const std::string good = "--actuator " + actuator() + " --output " + output() + " " + session();
  expectRefusal("--output " + output() + " " + POSITIONER_BAG, "--actuator is needed");
  expectRefusal("--urdf x.urdf " + session(), "--urdf and --report need --output");
  expectRefusal("--actuator " + actuator() + " --output " + output(), "recording (BAG) is needed");
  expectRefusal(good + " --cycles joint,pole:1", "The cycle \"pole:1\" is unknown");
  expectRefusal(good + " --cycles ''", "--cycles needs a value");
  expectRefusal(good + " --from tables", "--from: \"tables\" is ");
  expectRefusal(good + " --from samples", "/actuator/samples was not recorded");
  expectRefusal(good + " --speed 3", "--speed");
  expectRefusal(good + " --cycle joint", "--cycle");
  expectRefusal(good + " --output " + output(), "--output");
  expectRefusal(good + " --date yesterday", "--date: \"yesterday\" is not of the form");
  expectRefusal(good + " --urdf-template x.urdf", "--urdf-template serves --urdf only");
  expectRefusal("--force --output in.bag in.bag", "--output: in.bag is the file that BAG reads");
}

TEST_F(CalibrateBag, RefusesFilesThatItCannotRead) {
  const std::string to = " --output " + output() + " ";
  expectRefusal("--actuator " + path("no.yaml") + to + session(), path("no.yaml"));
  expectRefusal("--actuator " + actuator() + to + path("no.bag"), "no.bag: there is no such file");
  const std::string good = "--actuator " + actuator() + to + session();
  expectRefusal(good + " --config " + path("no.yaml"), path("no.yaml"));
  expectRefusal(good + " --config " + folder_.write("c.yaml", "dwell: {window: 1.0}\n"),
                "c.yaml:1: dwell.window");
  expectRefusal(good + " --truth " + kPositioner, "The truth has 0 poles");
  expectRefusal(good + " --urdf " + path("o.urdf") + " --urdf-template " + path("no.urdf"),
                "no.urdf");
  expectRefusal(good + " --report " + actuator() + "/folder", "cannot be made");
  expectRefusal(
      "--actuator " + std::string(kPositioner) + to + POSITIONER_BAG + " --urdf " + path("o.urdf"),
      "no robot description is shipped for the actuator two_axis_positioner");
}

TEST_F(CalibrateBag, RefusesRecordingsOfAnotherUnitAndDamagedOnes) {
  Actuator other = nominalUnit();
  other.serial = "unit-002";
  saveDescription(path("other.yaml"), {other}, OverwritePolicy::kRefuse);
  const std::string to = " --output " + output() + " ";
  expectRefusal("--actuator " + path("other.yaml") + to + session(),
                "recorded with the unit unit-001, but the description is of unit-002");
  const std::string whole = contentOf(session());
  expectRefusal(
      "--actuator " + actuator() + to + folder_.write("cut.bag", whole.substr(0, whole.size() / 2)),
      "rosbag reindex");
  expectRefusal("--actuator " + actuator() + " --ns /arm" + to + session(), "choose by --ns");
}

}  // namespace
}  // namespace sac
