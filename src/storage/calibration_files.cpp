#include "spherical_actuator_calibration/storage/calibration_files.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/urdf_file.hpp"
#include "spherical_actuator_calibration/assessment/report_file.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

/// Writes a file, or finds it there with this content already.
void writeOnce(const std::string& path, const std::string& content) {
  if (!fs::exists(path) || readInputFile(path) != content) {
    writeFileAtomically(path, content, OverwritePolicy::kRefuse);
  }
}

/// Whether a file is there with another content.
bool isTaken(const std::string& path, const std::string& content) {
  return fs::exists(path) && readInputFile(path) != content;
}

bool anyIdentified(const CalibrationState& state) {
  return std::find(state.identified.begin(), state.identified.end(), true) !=
         state.identified.end();
}

}  // namespace

bool CalibrationFiles::isSaved(std::uint32_t revision, Grade grade) const {
  // A folder that cannot be looked into holds nothing that is saved.
  std::error_code error;
  if (!fs::exists(directory_.description(revision), error)) {
    return false;
  }
  const std::string saved = gradeInReport(reportFile(revision));
  const bool is_judged = grade == Grade::kGood || grade == Grade::kUsable;
  return !is_judged || saved.empty() || saved == gradeName(grade);
}

std::string CalibrationFiles::reportFile(std::uint32_t revision) const {
  return (fs::path(directory_.report(revision)) / "report.yaml").string();
}

std::string CalibrationFiles::save(const LiveSession& session,
                                   const RobotDescription& robot) const {
  const Revision& revision = session.revision();
  if (!anyIdentified(revision.state)) {
    throw DataError("Nothing is calibrated yet: run a cycle first.");
  }
  const CalibratedDescription description = session.description(revision.date);
  const std::string yaml = renderDescription(description, directory_.description(revision.number));
  unsigned edition = 1;
  while (isTaken(directory_.description(revision.number, edition), yaml)) {
    ++edition;
  }
  const std::string yaml_path = directory_.description(revision.number, edition);
  if (!robot.urdf) {
    writeOnce(yaml_path, yaml);
    return "Saved " + yaml_path + "; no URDF, since " + robot.source + " is missing.";
  }
  const std::string urdf_path = directory_.urdf(revision.number);
  const std::string urdf = renderCalibratedUrdf(
      *robot.urdf, robot.source, session.calibration().start().actuator, description.actuator);
  writeOnce(yaml_path, yaml);
  writeOnce(urdf_path, urdf);
  return "Saved " + yaml_path + " and " + urdf_path + ".";
}

std::string CalibrationFiles::saveReport(const LiveSession& session) const {
  const Revision& revision = session.revision();
  std::string folder = directory_.report(revision.number);
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) {
    throw DataError(folder + ": the folder cannot be made: " + error.message() + ".");
  }
  // Samples may have come and gone since the last time.
  writeFileAtomically(reportFile(revision.number),
                      renderReport(session.calibration(), session.origin(revision.date), {}),
                      OverwritePolicy::kReplace);
  return folder;
}

}  // namespace sac
