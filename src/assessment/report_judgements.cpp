#include "report_judgements.hpp"

#include <string>

#include "spherical_actuator_calibration/assessment/torque_linearity.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {

void writeInfluences(YamlWriter& writer, const std::vector<SampleInfluence>& influences) {
  std::vector<std::string> lines;
  for (const SampleInfluence& influence : influences) {
    YamlLine line;
    line.add("id", std::to_string(influence.id));
    line.add("quantity", quantityName(influence.quantity));
    line.add("leverage", yamlNumber(influence.leverage));
    line.add("largest_shift", yamlNumber(influence.largest_shift));
    line.add("irreplaceable", yamlBoolean(influence.irreplaceable));
    line.add("parameter", influence.parameter);
    lines.push_back(line.text());
  }
  writer.list(1, "influences", lines);
}

void writeModelChoice(YamlWriter& writer, const std::vector<ModelFit>& fits) {
  std::vector<std::string> lines;
  for (const ModelFit& fit : fits) {
    YamlLine line;
    line.add("effects", yamlText(fit.effects));
    line.add("converged", yamlBoolean(fit.converged));
    line.add("parameters", std::to_string(fit.parameters));
    line.add("chi_square", yamlNumber(fit.chi_square));
    line.add("reduced_chi_square", yamlNumber(fit.reduced_chi_square));
    line.add("bic", yamlNumber(fit.bic));
    line.add("best", yamlBoolean(&fit == &bestOf(fits)));
    if (fit.held_out) {
      line.add("held_out", yamlNumber(*fit.held_out));
    }
    lines.push_back(line.text());
  }
  if (!lines.empty()) {
    writer.list(1, "model_choice", lines);
  }
}

void writeOrientationMap(YamlWriter& writer, const OrientationMapChoice& choice) {
  if (choice.record) {
    YamlLine line;
    line.add("chosen", yamlBoolean(choice.map != nullptr));
    line.add("regions", std::to_string(choice.record->regions));
    line.add("axes_rms", yamlNumber(choice.record->axes_rms));
    line.add("map_rms", yamlNumber(choice.record->map_rms));
    line.add("inside", yamlNumber(choice.record->inside));
    writer.entry(1, "orientation_map", line.text());
  }
}

void writeTorqueLinearity(YamlWriter& writer, const CalibrationSession& session) {
  if (!session.model().hasTorqueModel()) {
    return;
  }
  const auto linearity = torqueLinearity(session.samples(), session.config());
  writer.map(1, "torque_linearity");
  writer.entry(2, "sentence", yamlText(describe(linearity)));
  writer.entry(2, "told", yamlBoolean(linearity.has_value()));
  if (!linearity) {
    return;
  }
  std::vector<std::string> ids;
  for (const std::uint32_t id : linearity->samples) {
    ids.push_back(std::to_string(id));
  }
  const auto uncertain = [](const UncertainValue& share) {
    YamlLine line;
    line.add("value", yamlNumber(share.value)).add("stddev", yamlNumber(share.stddev));
    return line.text();
  };
  writer.entry(2, "coil", std::to_string(numberOf(linearity->coil)));
  writer.entry(2, "samples", yamlList(ids));
  writer.entry(2, "currents", yamlNumbers(linearity->currents));
  writer.entry(2, "full_current", yamlNumber(linearity->full_current));
  writer.entry(2, "deviation", uncertain(linearity->deviation));
  if (linearity->asymmetry) {
    writer.entry(2, "asymmetry", uncertain(*linearity->asymmetry));
  }
  writer.entry(2, "chi_square", yamlNumber(linearity->chi_square));
  writer.entry(2, "degrees_of_freedom", std::to_string(linearity->degrees_of_freedom));
  writer.entry(2, "probability", yamlNumber(linearity->probability));
}

}  // namespace sac
