#include "spherical_actuator_calibration/core/report_file.hpp"

#include <optional>
#include <sstream>

#include "spherical_actuator_calibration/core/model_choice.hpp"
#include "spherical_actuator_calibration/core/sample_influence.hpp"
#include "spherical_actuator_calibration/core/yaml_writer.hpp"

namespace spherical_actuator_calibration {
namespace {

std::string truthText(bool value) {
  return value ? "true" : "false";
}

std::string numberList(const std::vector<double>& values) {
  std::vector<std::string> items;
  items.reserve(values.size());
  for (const double value : values) {
    items.push_back(yamlNumber(value));
  }
  return yamlList(items);
}

/// Writes nested maps and lists, two spaces a level.
class ReportWriter {
 public:
  void map(int level, const std::string& key) { line(level, key + ":"); }
  void entry(int level, const std::string& key, const std::string& value) {
    line(level, key + ": " + value);
  }
  void optional(int level, const std::string& key, const std::optional<double>& value) {
    if (value) {
      entry(level, key, yamlNumber(*value));
    }
  }
  void list(int level, const std::string& key, const std::vector<std::string>& items) {
    line(level, key + (items.empty() ? ": []" : ":"));
    for (const std::string& item : items) {
      line(level + 1, "- " + item);
    }
  }
  void line(int level, const std::string& text) {
    text_ << std::string(2 * static_cast<std::size_t>(level), ' ') << text << "\n";
  }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

std::vector<std::string> estimateLines(const std::vector<ParameterEstimate>& estimates,
                                       bool with_initial) {
  std::vector<std::string> lines;
  for (const ParameterEstimate& estimate : estimates) {
    YamlLine line;
    line.add("name", estimate.name).add("nominal", yamlNumber(estimate.nominal));
    if (with_initial) {
      line.add("initial", yamlNumber(estimate.initial));
    }
    line.add("value", yamlNumber(estimate.value)).add("stddev", yamlNumber(estimate.stddev));
    line.add(with_initial ? "observable" : "identified", truthText(estimate.observable));
    lines.push_back(line.text());
  }
  return lines;
}

std::vector<std::string> residualLines(const std::vector<SampleResidual>& residuals) {
  std::vector<std::string> lines;
  for (const SampleResidual& residual : residuals) {
    YamlLine line;
    line.add("id", std::to_string(residual.id));
    line.add("quantity", residual.quantity == Quantity::kOrientation ? "orientation" : "torque");
    line.add("residual", yamlNumber(residual.residual));
    line.add("standardized", yamlNumber(residual.standardized));
    line.add("rejected", truthText(residual.rejected));
    if (residual.rejected) {
      line.add("reason", yamlText(residual.reason));
    }
    lines.push_back(line.text());
  }
  return lines;
}

void writeCycle(ReportWriter& writer, const CycleReport& report) {
  writer.line(2, "- cycle: " + cycleName(report.cycle));
  writer.entry(3, "coil", std::to_string(report.coil));
  writer.entry(3, "success", truthText(report.success));
  writer.entry(3, "message", yamlText(report.message));
  writer.entry(3, "samples_used", std::to_string(report.samples_used));
  writer.entry(3, "samples_rejected", std::to_string(report.samples_rejected));
  writer.entry(3, "iterations", std::to_string(report.iterations));
  writer.entry(3, "error_unit", yamlText(unitOf(report.error_measure)));
  writer.entry(3, "error_history", numberList(report.error_history));
  writer.optional(3, "orientation_rms", residualRms(report, Quantity::kOrientation));
  writer.optional(3, "torque_rms", residualRms(report, Quantity::kTorque));
  writer.entry(3, "reduced_chi_square", yamlNumber(report.reduced_chi_square));
  writer.entry(3, "condition_number", yamlNumber(report.condition_number));
  writer.entry(3, "solve_time", yamlNumber(report.solve_time));
  writer.entry(3, "orientation_uncertainty", yamlNumber(report.orientation_uncertainty));
  writer.entry(3, "torque_uncertainty", yamlNumber(report.torque_uncertainty));
  writer.list(3, "estimates", estimateLines(report.estimates, true));
  writer.list(3, "residuals", residualLines(report.residuals));
}

void writeValidation(ReportWriter& writer, const HeldOutValidation& validation) {
  YamlLine line;
  line.add("samples", std::to_string(validation.samples));
  line.add("orientations", std::to_string(validation.orientations));
  line.add("orientation_rms", yamlNumber(validation.orientation_rms));
  line.add("torques", std::to_string(validation.torques));
  line.add("torque_rms", yamlNumber(validation.torque_rms));
  line.add("reduced_chi_square", yamlNumber(validation.reduced_chi_square));
  line.add("probability", yamlNumber(validation.probability));
  writer.entry(1, "validation", line.text());
}

void writeOrigin(ReportWriter& writer,
                 const CalibrationSession& session,
                 const CalibrationOrigin& origin) {
  const Actuator& actuator = session.model().space().nominal();
  writer.entry(1, "actuator", yamlText(actuator.name));
  writer.entry(1, "serial", yamlText(actuator.serial));
  writer.entry(1, "date", yamlText(origin.date));
  writer.entry(1, "software", yamlText(origin.software));
  std::vector<std::string> sources;
  for (const RecordingSource& source : origin.recordings) {
    YamlLine line;
    line.add("recording", yamlText(source.recording)).add("checksum", yamlText(source.checksum));
    sources.push_back(line.text());
  }
  writer.list(1, "source", sources);
}

/// Of the observations of the last cycle, where it succeeded.
void writeInfluences(ReportWriter& writer, const CalibrationSession& session) {
  if (session.reports().empty()) {
    return;
  }
  std::vector<std::string> lines;
  for (const SampleInfluence& influence : sampleInfluences(session.model(),
                                                           session.samples(),
                                                           session.reports().back(),
                                                           session.state(),
                                                           session.config().estimation)) {
    YamlLine line;
    line.add("id", std::to_string(influence.id));
    line.add("quantity", influence.quantity == Quantity::kOrientation ? "orientation" : "torque");
    line.add("leverage", yamlNumber(influence.leverage));
    line.add("largest_shift", yamlNumber(influence.largest_shift));
    line.add("irreplaceable", influence.irreplaceable ? "true" : "false");
    line.add("parameter", influence.parameter);
    lines.push_back(line.text());
  }
  writer.list(1, "influences", lines);
}

void writeModelChoice(ReportWriter& writer, const CalibrationSession& session) {
  std::vector<std::string> lines;
  for (const ModelFit& fit : compareEffects(session.start(), session.samples(), session.config())) {
    YamlLine line;
    line.add("effects", yamlText(fit.effects));
    line.add("converged", truthText(fit.converged));
    line.add("parameters", std::to_string(fit.parameters));
    line.add("chi_square", yamlNumber(fit.chi_square));
    line.add("reduced_chi_square", yamlNumber(fit.reduced_chi_square));
    line.add("bic", yamlNumber(fit.bic));
    lines.push_back(line.text());
  }
  if (!lines.empty()) {
    writer.list(1, "model_choice", lines);
  }
}

}  // namespace

std::string renderReport(const CalibrationSession& session,
                         const CalibrationOrigin& origin,
                         const std::vector<std::string>& recording) {
  ReportWriter writer;
  writer.map(0, "calibration_report");
  writeOrigin(writer, session, origin);
  std::vector<std::string> lines;
  lines.reserve(recording.size());
  for (const std::string& line : recording) {
    lines.push_back(yamlText(line));
  }
  writer.list(1, "recording", lines);
  writer.map(1, "configuration");
  std::istringstream configuration(renderCalibrationConfig(session.config()));
  for (std::string line; std::getline(configuration, line);) {
    writer.line(2, line);
  }
  writer.line(1, session.reports().empty() ? "cycles: []" : "cycles:");
  for (const CycleReport& report : session.reports()) {
    writeCycle(writer, report);
  }
  if (const auto validation = session.validation()) {
    writeValidation(writer, *validation);
  }
  writer.list(1, "parameters", estimateLines(session.parameters(), false));
  writeInfluences(writer, session);
  writeModelChoice(writer, session);
  return writer.text();
}

}  // namespace spherical_actuator_calibration
