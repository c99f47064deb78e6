#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "calibrate_bag_diagnosis.hpp"
#include "calibrate_bag_options.hpp"
#include "calibrate_bag_setup.hpp"
#include "calibration_text.hpp"
#include "spherical_actuator_calibration/actuator/actuator_design.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/urdf_file.hpp"
#include "spherical_actuator_calibration/assessment/calibration_certificate.hpp"
#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/assessment/covariance_file.hpp"
#include "spherical_actuator_calibration/assessment/model_choice.hpp"
#include "spherical_actuator_calibration/assessment/report_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/version.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"
#include "spherical_actuator_calibration/ros/conversion/file_checksum.hpp"
#include "spherical_actuator_calibration/ros/conversion/utc_date.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"
#include "spherical_actuator_calibration/ros/recording/report_page.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

constexpr int kComplete = 0;
constexpr int kIncomplete = 1;

/// The robot description that is shipped for an actuator: share/ lies beside the lib/ that holds
/// this program, in a build as in an installation.
std::string shippedUrdf(const std::string& actuator) {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path prefix = program.parent_path().parent_path().parent_path();
  const fs::path urdf =
      prefix / "share" / program.parent_path().filename() / "urdf" / (actuator + ".urdf");
  if (!fs::exists(urdf)) {
    throw ConfigError("--urdf: no robot description is shipped for the actuator " + actuator +
                      "; name one by --urdf-template.");
  }
  return urdf.string();
}

/// Files that a run reads and writes besides the recordings.
struct Files {
  std::string description;
  std::string urdf_template;  ///< empty: no URDF is wanted
  std::string urdf;
  std::string report;       ///< empty: no report is wanted
  std::string report_page;  ///< the same for people
  std::string covariance;   ///< empty: none is wanted
  std::string certificate;  ///< the same
};

Files prepareFiles(const CalibrateBagOptions& options, const Actuator& nominal) {
  Files files;
  files.description = options.output_path;
  if (options.urdf_path) {
    files.urdf = *options.urdf_path;
    files.urdf_template =
        options.urdf_template_path ? *options.urdf_template_path : shippedUrdf(nominal.name);
    renderCalibratedUrdf(readInputFile(files.urdf_template), files.urdf_template, nominal, nominal);
  }
  if (options.report_folder) {
    files.report = (fs::path(*options.report_folder) / "report.yaml").string();
    const fs::path page = fs::path(*options.report_folder) / "report.html";
    files.report_page = options.no_page ? "" : page.string();
  }
  files.covariance = options.covariance_path.value_or("");
  files.certificate = options.certificate_path.value_or("");
  for (const std::string& path : {files.description,
                                  files.urdf,
                                  files.covariance,
                                  files.certificate,
                                  options.corrected_path.value_or("")}) {
    requireNewFile(path, options.overwrite);
  }
  if (options.report_folder) {
    std::error_code error;
    fs::create_directories(*options.report_folder, error);
    if (error) {
      throw DataError(*options.report_folder + ": the folder cannot be made: " + error.message() +
                      ".");
    }
  }
  requireNewFile(files.report, options.overwrite);
  requireNewFile(files.report_page, options.overwrite);
  return files;
}

CalibrationOrigin originOf(const CalibrateBagOptions& options) {
  CalibrationOrigin origin;
  origin.date = options.date ? *options.date : utcDate();
  for (const std::string& bag : options.bags) {
    origin.recordings.push_back({fs::path(bag).filename().string(), fileChecksum(bag)});
  }
  origin.software = packageVersion();
  return origin;
}

std::optional<Actuator> truthOf(const CalibrateBagOptions& options, const Actuator& nominal) {
  if (!options.truth_path) {
    return std::nullopt;
  }
  Actuator truth = loadActuator(*options.truth_path);
  requireSameDesign(nominal, truth);
  return truth;
}

bool isMotion(const CycleRequest& request) {
  return request.cycle == Cycle::kMotion;
}

MotionUse motionUse(const CalibrateBagOptions& options) {
  if (!options.cycles) {
    return MotionUse::kWithoutTorques;
  }
  const bool is_asked = std::any_of(options.cycles->begin(), options.cycles->end(), isMotion);
  return is_asked ? MotionUse::kAlways : MotionUse::kNever;
}

Recording readBags(const OpenRecordings& recordings,
                   const CalibrateBagOptions& options,
                   const Actuator& nominal,
                   const CalibrationConfig& config) {
  RecordingOptions reading;
  reading.ns = options.ns;
  reading.frames = config.frames;
  reading.samples = config.samples;
  reading.source = options.source;
  reading.motion = motionUse(options);
  reading.progress = terminalProgress("reading");
  Recording recording = readRecordings(recordings, nominal, reading);
  std::string names;
  const std::vector<std::string> changed = changedStreamOptions(config);
  for (const std::string& option : changed) {
    names += (names.empty() ? "" : ", ") + option;
  }
  // What was recorded with the samples acted on them.
  if (options.config_path && !recording.report.has_streams && !names.empty()) {
    recording.report.notes.push_back(
        "Samples are taken as they were recorded, so that " + names + " of the configuration " +
        (changed.size() > 1 ? "have" : "has") + " no effect: --from streams.");
  }
  return recording;
}

/// Whether motion is to be calibrated: asked for, or recorded without any torque.
bool takesMotion(const Recording& recording,
                 const CalibrateBagOptions& options,
                 const Actuator& nominal) {
  if (options.cycles) {
    return std::any_of(options.cycles->begin(), options.cycles->end(), isMotion);
  }
  const bool has_torque = std::any_of(recording.samples.begin(),
                                      recording.samples.end(),
                                      [](const Sample& sample) { return sample.has_torque; });
  return !has_torque && nominal.hasTorqueModel() && tellsMotion(recording.motion);
}

/// Whether inertia, friction, unbalance and delays belong to the parameters: not beside cycles of
/// samples, whose torques are without the one of the same dwell without current, so that they tell
/// of no unbalance. The cycle motion knows them all the same.
bool isMotionAlone(const CalibrateBagOptions& options) {
  return !options.cycles || std::all_of(options.cycles->begin(), options.cycles->end(), isMotion);
}

std::vector<CycleRequest> cyclesOf(const CalibrationSession& session,
                                   const CalibrateBagOptions& options) {
  const EstimationOptions& estimation = session.config().estimation;
  if (options.cycles) {
    return expandCoils(*options.cycles, session.model(), session.samples(), estimation);
  }
  if (session.motion() != nullptr) {
    return {{Cycle::kMotion}};
  }
  return possibleCycles(session.model(), session.samples(), estimation);
}

void runCycles(CalibrationSession& session, const CalibrateBagOptions& options) {
  for (const CycleRequest& request : cyclesOf(session, options)) {
    if (request.cycle == Cycle::kRefine && session.motion() && session.samples().empty()) {
      std::cout << "refine: no sample was recorded, it has nothing to add to the motion.\n";
      continue;
    }
    const CycleReport& report =
        session.run(options.report_folder ? request : withoutExpectedErrors(request));
    std::cout << cycleParagraph(report) << std::flush;
  }
}

bool hasFailure(const CalibrationSession& session) {
  const auto has_failed = [](const CycleReport& report) { return !report.success; };
  const auto& reports = session.reports();
  return std::any_of(reports.begin(), reports.end(), has_failed);
}

/// Runs the cycles unless the wiring is wrong; what explains the samples, where it was looked for.
std::vector<Diagnosis> calibrate(CalibrationSession& session, const CalibrateBagOptions& options) {
  std::vector<Diagnosis> diagnoses = diagnoseMistakes(session);
  if (diagnoses.empty()) {
    runCycles(session, options);
    const bool is_wanted = options.diagnose || options.corrected_path || hasFailure(session);
    if (!is_wanted) {
      return diagnoses;
    }
    diagnoses = diagnose(session);
  } else {
    std::cout << "No cycle runs before this is mended:\n";
  }
  if (options.diagnose || !diagnoses.empty()) {
    std::cout << diagnosisLines(diagnoses);
  }
  if (options.corrected_path) {
    writeCorrection(session, diagnoses, *options.corrected_path, options.overwrite);
  }
  return diagnoses;
}

/// Without any cycle.
int diagnoseOnly(const CalibrationSession& session, const CalibrateBagOptions& options) {
  const std::vector<Diagnosis> diagnoses = diagnose(session);
  std::cout << diagnosisLines(diagnoses);
  if (options.corrected_path) {
    writeCorrection(session, diagnoses, *options.corrected_path, options.overwrite);
  }
  return diagnoses.empty() ? kComplete : kIncomplete;
}

bool hasResult(const CalibrationSession& session) {
  for (const CycleReport& report : session.reports()) {
    if (report.success) {
      return true;
    }
  }
  return false;
}

void printResult(const CalibrationSession& session, const std::optional<Actuator>& truth) {
  if (const auto validation = session.validation()) {
    std::cout << validationParagraph(*validation);
  }
  std::cout << "\n" << parameterTable(session, truth);
  std::cout << influenceParagraph(session) << linearityParagraph(session);
  // Samples judge effects; motion has more of its own.
  if (session.motion() == nullptr) {
    for (const std::string& line :
         describe(compareEffects(session.start(), session.samples(), session.config()))) {
      std::cout << line << "\n";
    }
  }
  std::cout << openParagraph(session);
  if (const std::string& map = session.orientationMap().sentence; !map.empty()) {
    std::cout << map << "\n";
  }
}

/// The last word.
void printGrade(const CalibrationSession& session) {
  const GradedCalibration graded = gradeCalibration(session);
  std::cout << "grade: " << gradeName(graded.grade) << "\n" << graded.reason << "\n";
}

/// Nobody certifies what the samples contradict.
void writeCertificate(const CalibrationSession& session,
                      const CalibrationOrigin& origin,
                      const CertificateIssuer& issuer,
                      const std::string& path,
                      OverwritePolicy policy) {
  if (!isSound(gradeCalibration(session).grade)) {
    std::cout << "Certificate: " << path << " is not written: see the grade.\n";
    return;
  }
  writeFileAtomically(path, renderCertificate(session, origin, issuer), policy);
  std::cout << "Certificate: " << path << "\n";
}

void writeResult(const CalibrationSession& session,
                 const CalibrationOrigin& origin,
                 const CertificateIssuer& issuer,
                 const Files& files,
                 OverwritePolicy policy) {
  if (files.description.empty()) {
    std::cout << "Nothing is written: --output OUT.yaml keeps the result.\n";
    return;
  }
  const CalibratedDescription result =
      gradedDescription(session, origin, gradeCalibration(session));
  saveDescription(files.description, result, policy);
  std::cout << "Calibrated description: " << files.description << "\n";
  if (!files.covariance.empty()) {
    writeFileAtomically(files.covariance, renderCovariance(session), policy);
    std::cout << "Covariance: " << files.covariance << "\n";
  }
  if (!files.certificate.empty()) {
    writeCertificate(session, origin, issuer, files.certificate, policy);
  }
  if (!files.urdf.empty()) {
    writeCalibratedUrdf(files.urdf_template,
                        files.urdf,
                        session.model().space().nominal(),
                        result.actuator,
                        policy);
    std::cout << "Calibrated URDF: " << files.urdf << "\n";
  }
}

/// The page alone may fail: its figures are there then, and the calibration is as good without it.
void writeReport(const std::string& report, const Files& files, OverwritePolicy policy) {
  writeFileAtomically(files.report, report, policy);
  std::cout << "All figures: " << files.report << "\n" << std::flush;
  const bool is_wanted = !files.report_page.empty();
  const std::string failure = is_wanted ? writeReportPage(files.report, files.report_page) : "";
  if (!failure.empty()) {
    std::fprintf(stderr, "calibrate_bag: warning: %s\n", failure.c_str());
  } else if (is_wanted) {
    std::cout << "Report: " << files.report_page << "\n";
  }
}

void print(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    std::cout << line << "\n";
  }
}

int calibrateBag(const CalibrateBagOptions& options) {
  const OpenRecordings recordings(options.bags);
  const CalibrateBagSetup setup = readSetup(options, recordings);
  const CalibratedDescription& start = setup.start;
  CalibrationConfig config = setup.config;
  const std::optional<Actuator> truth = truthOf(options, start.actuator);
  const Files files = prepareFiles(options, start.actuator);
  const CertificateIssuer issuer =
      options.issuer_path ? loadCertificateIssuer(*options.issuer_path) : CertificateIssuer{};

  print(setup.lines);
  Recording recording = readBags(recordings, options, start.actuator, config);
  const bool takes_motion = takesMotion(recording, options, start.actuator);
  if (takes_motion) {
    recording.report.missing.clear();
  }
  const std::vector<std::string> lines = describe(recording.report);
  print(lines);
  if (takes_motion && isMotionAlone(options)) {
    config.effects = withMotionEffects(config.effects);
  }
  CalibrationSession session(start, std::move(recording.samples), config);
  if (takes_motion) {
    session.setMotion(std::make_shared<const MotionRecording>(std::move(recording.motion)));
  } else if (session.samples().empty()) {
    std::cout << "No sample was found: let the rotor rest longer, or see above what was dropped.\n";
  }
  if (options.check) {
    return printCheck(session) ? kComplete : kIncomplete;
  }
  if (options.diagnose && options.output_path.empty()) {
    return diagnoseOnly(session, options);
  }
  const std::vector<Diagnosis> diagnoses = calibrate(session, options);
  const bool has_result = hasResult(session);
  if (has_result) {
    printResult(session, truth);
  }
  const CalibrationOrigin origin = originOf(options);
  if (!files.report.empty()) {
    writeReport(renderReport(session, origin, lines, diagnoses), files, options.overwrite);
  }
  if (!has_result) {
    std::cout << "No cycle succeeded: "
              << (files.description.empty() ? "the result" : files.description)
              << " is not written.\n";
    printGrade(session);
    return kIncomplete;
  }
  writeResult(session, origin, issuer, files, options.overwrite);
  printGrade(session);
  return session.isComplete() ? kComplete : kIncomplete;
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("calibrate_bag", [&] {
    const auto options = sac::parseCalibrateBagOptions(argc, argv, std::cout);
    return options ? sac::calibrateBag(*options) : sac::kComplete;
  });
}
