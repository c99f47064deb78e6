#include "spherical_actuator_calibration/assessment/report_file.hpp"

#include <cstddef>
#include <fstream>
#include <optional>
#include <sstream>

#include "calibration_verdict.hpp"
#include "report_judgements.hpp"
#include "spherical_actuator_calibration/assessment/model_choice.hpp"
#include "spherical_actuator_calibration/assessment/sample_influence.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/calibration/cycle_title.hpp"
#include "spherical_actuator_calibration/calibration/sample_coverage.hpp"
#include "spherical_actuator_calibration/estimation/workspace_uncertainty.hpp"

namespace sac {
namespace {

std::vector<std::string> texts(const std::vector<std::string>& plain) {
  std::vector<std::string> lines;
  lines.reserve(plain.size());
  for (const std::string& text : plain) {
    lines.push_back(yamlText(text));
  }
  return lines;
}

std::vector<std::string> matrixLines(const Eigen::MatrixXd& matrix) {
  std::vector<std::string> lines;
  lines.reserve(static_cast<std::size_t>(matrix.rows()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const Eigen::RowVectorXd row = matrix.row(i);
    lines.push_back(yamlNumbers(row));
  }
  return lines;
}

/// With `initial` and `observable` of a cycle, or with `identified` of the parameters in force.
YamlLine estimateLine(const ParameterEstimate& estimate, bool is_of_cycle) {
  YamlLine line;
  line.add("name", estimate.name).add("nominal", yamlNumber(estimate.nominal));
  if (is_of_cycle) {
    line.add("initial", yamlNumber(estimate.initial));
  }
  line.add("value", yamlNumber(estimate.value)).add("stddev", yamlNumber(estimate.stddev));
  line.add(is_of_cycle ? "observable" : "identified", yamlBoolean(estimate.observable));
  line.add("unit", yamlText(estimate.unit));
  return line;
}

std::vector<std::string> estimateLines(const std::vector<ParameterEstimate>& estimates) {
  std::vector<std::string> lines;
  lines.reserve(estimates.size());
  for (const ParameterEstimate& estimate : estimates) {
    lines.push_back(estimateLine(estimate, true).text());
  }
  return lines;
}

/// To what a coordinate belongs.
const char* kindOf(const ParameterSpace& space, Eigen::Index parameter) {
  if (parameter < space.pole(0)) {
    return "joint";
  }
  if (parameter < space.coil(0)) {
    return "pole";
  }
  return parameter < space.effect() ? "coil" : "effect";
}

void writeParameters(YamlWriter& writer, const CalibrationSession& session) {
  std::vector<std::string> lines;
  for (const ParameterEstimate& estimate : session.parameters()) {
    YamlLine line = estimateLine(estimate, false);
    const auto parameter = static_cast<Eigen::Index>(lines.size());
    line.add("kind", kindOf(session.model().space(), parameter));
    lines.push_back(line.text());
  }
  writer.list(1, "parameters", lines);
}

std::vector<std::string> residualLines(const std::vector<SampleResidual>& residuals) {
  std::vector<std::string> lines;
  for (const SampleResidual& residual : residuals) {
    YamlLine line;
    line.add("id", std::to_string(residual.id));
    line.add("quantity", quantityName(residual.quantity));
    line.add("residual", yamlNumber(residual.residual));
    line.add("unit", unitOf(residual.quantity));
    line.add("standardized", yamlNumber(residual.standardized));
    line.add("rejected", yamlBoolean(residual.rejected));
    if (residual.rejected) {
      line.add("reason", yamlText(residual.reason));
    }
    lines.push_back(line.text());
  }
  return lines;
}

/// What became of a recording of motion.
void writeMotion(YamlWriter& writer, const MotionSummary& motion) {
  writer.map(3, "motion");
  writer.entry(4, "duration", yamlNumber(motion.duration));
  writer.entry(4, "windows", std::to_string(motion.windows));
  writer.entry(4, "windows_used", std::to_string(motion.used));
  std::vector<std::string> reasons;
  for (const WindowsLeftOut& left_out : motion.left_out) {
    YamlLine line;
    line.add("count", std::to_string(left_out.count)).add("reason", yamlText(left_out.reason));
    reasons.push_back(line.text());
  }
  writer.list(4, "windows_left_out", reasons);
  writer.entry(4, "orientations", std::to_string(motion.orientations));
  writer.entry(4, "orientations_rejected", std::to_string(motion.orientations_rejected));
  writer.entry(4, "joint_stddev", yamlNumbers(motion.joint_stddev));
  writer.entry(4, "current_stddev", yamlNumber(motion.current_stddev));
  writer.entry(4, "orientation_stddev", yamlNumber(motion.orientation_stddev));
  if (motion.response) {
    YamlLine line;
    line.add("delay", yamlNumber(motion.response->delay))
        .add("time_constant", yamlNumber(motion.response->lag))
        .add("stddev", yamlNumber(motion.response->lateness_stddev));
    writer.entry(4, "commands", line.text());
  }
  const HeldOutMotion& held_out = motion.held_out;
  writer.entry(4,
               "held_out",
               "{windows: " + std::to_string(held_out.windows) +
                   ", rejected: " + std::to_string(held_out.rejected) +
                   ", orientations: " + std::to_string(held_out.orientations) + "}");
  writer.entry(4, "window_chi_square", yamlNumber(motion.window_chi_square));
  writer.entry(4, "orientation_chi_square", yamlNumber(motion.orientation_chi_square));
}

void writeCycle(YamlWriter& writer, const CycleReport& report, bool has_joints) {
  writer.line(2, "- cycle: " + cycleName(report.cycle));
  writer.entry(3, "title", cycleTitle(report.cycle, report.coil));
  writer.entry(3, "title_of_kind", cyclesTitle(report.cycle));
  writer.entry(3, "coil", std::to_string(numberOrZero(report.coil)));
  writer.entry(3, "success", yamlBoolean(report.success));
  writer.entry(3, "message", yamlText(report.message));
  writer.entry(3, "samples_used", std::to_string(report.samples_used));
  writer.entry(3, "samples_rejected", std::to_string(report.samples_rejected));
  writer.entry(3, "iterations", std::to_string(report.iterations));
  writer.entry(3, "error_unit", yamlText(unitOf(report.error_measure)));
  writer.entry(3, "error_history", yamlNumbers(report.error_history));
  writer.optional(3, "orientation_rms", residualRms(report, Quantity::kOrientation));
  writer.optional(3, "torque_rms", residualRms(report, Quantity::kTorque));
  writer.entry(3, "reduced_chi_square", yamlNumber(report.reduced_chi_square));
  writer.entry(3, "degrees_of_freedom", std::to_string(report.degrees_of_freedom));
  writer.entry(3, "condition_number", yamlNumber(report.condition_number));
  writer.entry(3, "solve_time", yamlNumber(report.solve_time));
  if (has_joints) {
    writer.entry(3, "orientation_uncertainty", yamlNumber(report.orientation_uncertainty));
  }
  writer.entry(3, "torque_uncertainty", yamlNumber(report.torque_uncertainty));
  if (report.motion) {
    writeMotion(writer, *report.motion);
  }
  writer.list(3, "estimates", estimateLines(report.estimates));
  writer.list(3, "residuals", residualLines(report.residuals));
}

void writeValidation(YamlWriter& writer, const HeldOutValidation& validation) {
  writer.map(1, "validation");
  writer.entry(2, "of", validation.things());
  writer.entry(2, "samples", std::to_string(validation.samples));
  writer.entry(2, "orientations", std::to_string(validation.orientations));
  writer.entry(2, "orientation_rms", yamlNumber(validation.orientation_rms));
  writer.entry(2, "torques", std::to_string(validation.torques));
  writer.entry(2, "torque_rms", yamlNumber(validation.torque_rms));
  writer.entry(2, "reduced_chi_square", yamlNumber(validation.reduced_chi_square));
  writer.entry(2, "probability", yamlNumber(validation.probability));
  writer.entry(2, "verdict", yamlText(verdict(validation)));
  writer.list(2, "residuals", residualLines(validation.residuals));
}

void writeOrigin(YamlWriter& writer,
                 const CalibrationSession& session,
                 const CalibrationOrigin& origin) {
  const Actuator& actuator = session.model().space().nominal();
  writer.entry(1, "actuator", yamlText(actuator.name));
  writer.entry(1, "serial", yamlText(actuator.serial));
  writer.entry(1, "date", yamlText(origin.date));
  writer.entry(1, "software", yamlText(origin.software));
  if (origin.revision) {
    writer.entry(1, "revision", std::to_string(*origin.revision));
  }
  std::vector<std::string> sources;
  for (const RecordingSource& source : origin.recordings) {
    YamlLine line;
    line.add("recording", yamlText(source.recording)).add("checksum", yamlText(source.checksum));
    sources.push_back(line.text());
  }
  writer.list(1, "source", sources);
}

void writeVerdict(YamlWriter& writer, const CalibrationVerdict& verdict) {
  YamlLine line;
  line.add("grade", gradeName(verdict.graded.grade));
  line.add("sound", isSound(verdict.graded.grade) ? "true" : "false");
  line.add("sentence", yamlText(verdict.graded.reason));
  writer.entry(1, "verdict", line.text());
  writer.list(1, "next_steps", texts(verdict.next_steps));
}

void writeSamples(YamlWriter& writer, const CalibrationSession& session) {
  const double threshold = session.config().estimation.current_threshold;
  std::vector<std::string> lines;
  for (const Sample& sample : session.samples()) {
    std::vector<std::string> coils;
    for (const Excitation& excitation : excitedCoils(sample, threshold)) {
      coils.push_back(std::to_string(numberOf(excitation.coil)));
    }
    YamlLine line;
    line.add("id", std::to_string(sample.id));
    const bool has_joints = session.model().space().joints() > 0;
    line.add(has_joints ? "joint_position" : "turns", yamlNumbers(sample.joint_position));
    line.add("orientation", yamlBoolean(sample.has_orientation));
    line.add("torque", yamlBoolean(sample.has_torque));
    line.add("coils", yamlList(coils));
    line.add("validation", yamlBoolean(sample.validation));
    lines.push_back(line.text());
  }
  writer.list(1, "samples", lines);
}

void writeCoverage(YamlWriter& writer, const CalibrationSession& session) {
  const SampleCoverage coverage = sampleCoverage(session.model(),
                                                 session.samples(),
                                                 session.state().belief.x,
                                                 session.config().estimation.current_threshold);
  const Actuator& actuator = session.model().space().nominal();
  std::vector<std::string> joints;
  for (std::size_t k = 0; k < session.model().space().joints(); ++k) {
    YamlLine line;
    line.add("name", yamlText(actuator.joints[k].name));
    line.add("lowest", yamlNumber(coverage.joints[k].lowest));
    line.add("highest", yamlNumber(coverage.joints[k].highest));
    joints.push_back(line.text());
  }
  const auto counts = [](const std::vector<std::uint32_t>& numbers) {
    std::vector<std::string> items;
    items.reserve(numbers.size());
    for (const std::uint32_t count : numbers) {
      items.push_back(std::to_string(count));
    }
    return yamlList(items);
  };
  writer.map(1, "coverage");
  writer.list(2, "joints", joints);
  writer.entry(2, "poles", counts(coverage.poles));
  writer.entry(2, "coils", counts(coverage.coils));
}

/// Unit vectors of the joints' axes: in the reference pose, in the frame of the description.
void writeJointAxes(YamlWriter& writer, const CalibrationSession& session) {
  const ParameterSpace& space = session.model().space();
  const Actuator identified = space.actuatorAt(session.state().belief.x);
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < space.joints(); ++k) {
    YamlLine line;
    line.add("name", yamlText(space.nominal().joints[k].name));
    line.add("nominal", yamlNumbers(space.nominal().joints[k].axis));
    line.add("identified", yamlNumbers(identified.joints[k].axis));
    lines.push_back(line.text());
  }
  writer.list(1, "joint_axes", lines);
}

void writeWorkspace(YamlWriter& writer, const CalibrationSession& session) {
  const WorkspaceMap map = workspaceMap(session.model(), session.state().belief);
  writer.map(1, "workspace");
  writer.entry(2, "tilt", yamlNumbers(map.tilt));
  const bool has_joints = session.model().space().joints() > 0;
  writer.list(2, "orientation", matrixLines(has_joints ? map.orientation : Eigen::MatrixXd()));
  writer.list(2, "torque", matrixLines(map.torque));
}

void writeDiagnoses(YamlWriter& writer, const std::vector<Diagnosis>& diagnoses) {
  std::vector<std::string> lines;
  for (const Diagnosis& diagnosis : diagnoses) {
    YamlLine line;
    line.add("cause", yamlText(diagnosis.cause));
    line.add("message", yamlText(diagnosis.message));
    line.add("evidence", yamlNumber(diagnosis.evidence));
    lines.push_back(line.text());
  }
  writer.list(1, "diagnoses", lines);
}

void writeConfiguration(YamlWriter& writer, const CalibrationConfig& config) {
  writer.map(1, "configuration");
  std::istringstream configuration(renderCalibrationConfig(config));
  for (std::string line; std::getline(configuration, line);) {
    writer.line(2, line);
  }
}

}  // namespace

std::string renderReport(const CalibrationSession& session,
                         const CalibrationOrigin& origin,
                         const std::vector<std::string>& recording,
                         const std::vector<Diagnosis>& diagnoses) {
  const std::vector<SampleInfluence> influences = sampleInfluences(session);
  // Samples judge effects; motion has more of its own.
  const std::vector<ModelFit> fits =
      session.motion() == nullptr
          ? compareEffects(session.start(), session.samples(), session.config())
          : std::vector<ModelFit>();
  YamlWriter writer;
  writer.map(0, "calibration_report");
  writeOrigin(writer, session, origin);
  writeVerdict(writer, judgeCalibration(session, influences, fits));
  writeDiagnoses(writer, diagnoses);
  writer.list(1, "recording", texts(recording));
  writeConfiguration(writer, session.config());
  writeSamples(writer, session);
  writer.line(1, session.reports().empty() ? "cycles: []" : "cycles:");
  for (const CycleReport& report : session.reports()) {
    writeCycle(writer, report, session.model().space().joints() > 0);
  }
  if (const auto validation = session.validation()) {
    writeValidation(writer, *validation);
  }
  writeParameters(writer, session);
  if (session.model().space().joints() > 0) {
    writeJointAxes(writer, session);
  }
  writeCoverage(writer, session);
  writeWorkspace(writer, session);
  writeInfluences(writer, influences);
  writeOrientationMap(writer, session.orientationMap());
  writeModelChoice(writer, fits);
  writeTorqueLinearity(writer, session);
  return writer.text();
}

// By its text: see writeVerdict().
std::string gradeInReport(const std::string& path) {
  constexpr std::size_t kHead = 4096;  // byte
  constexpr char kKey[] = "\n  verdict: {grade: ";
  if (!unreadableKind(path).empty()) {
    return {};
  }
  std::string head(kHead, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  const std::size_t key = head.find(kKey);
  if (key == std::string::npos) {
    return {};
  }
  const std::size_t begin = key + sizeof kKey - 1;
  return head.substr(begin, head.find(',', begin) - begin);
}

}  // namespace sac
