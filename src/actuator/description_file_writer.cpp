#include <algorithm>

#include "description_parts.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"

namespace sac {
namespace {

void addOptional(YamlLine& line, const std::string& key, const std::optional<double>& value) {
  if (value) {
    line.add(key, yamlNumber(*value));
  }
}

void addStddev(YamlLine& line, const YamlLine& stddev) {
  if (!stddev.empty()) {
    line.add("stddev", stddev.text());
  }
}

template <typename Values>
bool hasValue(const Values& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; });
}

std::string jointLine(const JointAxis& joint, const JointStddev& stddev) {
  YamlLine line;
  line.add("name", yamlText(joint.name));
  line.add("axis", yamlNumbers(joint.axis));
  line.add("offset", yamlNumber(joint.offset));
  if (hasValue(joint.correction.linear)) {
    line.add("linear", yamlNumbers(joint.correction.linear));
  }
  if (hasValue(joint.correction.harmonics)) {
    line.add("harmonics", yamlNumbers(joint.correction.harmonics));
  }
  YamlLine values;
  addOptional(values, "offset", stddev.offset);
  addOptional(values, "axis_u", stddev.axis_u);
  addOptional(values, "axis_v", stddev.axis_v);
  if (stddev.linear) {
    values.add("linear", yamlNumbers(*stddev.linear));
  }
  if (stddev.harmonics) {
    values.add("harmonics", yamlNumbers(*stddev.harmonics));
  }
  addStddev(line, values);
  return line.text();
}

/// What follows the angles of poles and coils: gains other than 1, standard deviations.
template <typename PoleOrCoil>
void addGainAndStddev(YamlLine& line, const PoleOrCoil& axis, const AxisStddev& stddev) {
  if (axis.gain != 1.0) {
    line.add("gain", yamlNumber(axis.gain));
  }
  YamlLine values;
  addOptional(values, "polar", stddev.polar);
  addOptional(values, "azimuth", stddev.azimuth);
  addOptional(values, "gain", stddev.gain);
  addStddev(line, values);
}

std::string poleLine(const PoleAxis& pole, const AxisStddev& stddev) {
  YamlLine line;
  line.add("polar", yamlNumber(pole.polar));
  line.add("azimuth", yamlNumber(pole.azimuth));
  line.add("polarity", std::to_string(pole.polarity));
  addGainAndStddev(line, pole, stddev);
  return line.text();
}

std::string coilLine(const CoilAxis& coil, const AxisStddev& stddev) {
  YamlLine line;
  line.add("polar", yamlNumber(coil.polar));
  line.add("azimuth", yamlNumber(coil.azimuth));
  addGainAndStddev(line, coil, stddev);
  return line.text();
}

std::string cycleLine(const CycleRecord& record) {
  YamlLine line;
  line.add("cycle", yamlText(record.cycle));
  line.add("coil", std::to_string(numberOrZero(record.coil)));
  line.add("samples_used", std::to_string(record.samples_used));
  line.add("samples_rejected", std::to_string(record.samples_rejected));
  line.add("error_before", yamlNumber(record.error_before));
  line.add("error_after", yamlNumber(record.error_after));
  line.add("unit", yamlText(record.unit));
  line.add("reduced_chi_square", yamlNumber(record.reduced_chi_square));
  return line.text();
}

std::string validationLine(const ValidationRecord& record) {
  YamlLine line;
  line.add("samples", std::to_string(record.samples));
  addOptional(line, "orientation_rms", record.orientation_rms);
  addOptional(line, "torque_rms", record.torque_rms);
  if (record.contradicted) {
    line.add("contradicted", "true");
  }
  return line.text();
}

std::string mapLine(const MapRecord& record) {
  YamlLine line;
  line.add("regions", std::to_string(record.regions));
  line.add("axes_rms", yamlNumber(record.axes_rms));
  line.add("map_rms", yamlNumber(record.map_rms));
  line.add("inside", yamlNumber(record.inside));
  return line.text();
}

/// Writes the axes of poles or coils, unless there are none.
template <typename PoleOrCoil, typename LineOf>
void writeAxes(YamlWriter& writer,
               const std::string& key,
               const std::vector<PoleOrCoil>& axes,
               const std::vector<AxisStddev>& stddevs,
               LineOf line_of) {
  if (!stddevs.empty() && stddevs.size() != axes.size()) {
    throw ConfigError(key + ": " + std::to_string(stddevs.size()) +
                      " standard deviations do not belong to " + std::to_string(axes.size()) + " " +
                      key + ".");
  }
  if (axes.empty()) {
    return;
  }
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    lines.push_back(line_of(axes[i], stddevs.empty() ? AxisStddev{} : stddevs[i]));
  }
  writer.list(1, key, lines);
}

void writeCalibration(YamlWriter& writer, const CalibrationRecord& record) {
  writer.map(1, "calibration");
  writer.entry(2, "date", yamlText(record.date));
  writer.entry(2, "revision", std::to_string(record.revision));
  std::vector<std::string> source;
  for (const RecordingSource& item : record.source) {
    YamlLine line;
    line.add("recording", yamlText(item.recording)).add("checksum", yamlText(item.checksum));
    source.push_back(line.text());
  }
  writer.list(2, "source", source);
  writer.entry(2, "software", yamlText(record.software));
  std::vector<std::string> cycles;
  for (const CycleRecord& cycle : record.cycles) {
    cycles.push_back(cycleLine(cycle));
  }
  writer.list(2, "cycles", cycles);
  if (!record.effects.empty()) {
    std::vector<std::string> effects;
    for (const EffectRecord& effect : record.effects) {
      effects.push_back(YamlLine()
                            .add("name", yamlText(effect.name))
                            .add("value", yamlNumber(effect.value))
                            .add("stddev", yamlNumber(effect.stddev))
                            .text());
    }
    writer.list(2, "effects", effects);
  }
  std::vector<std::string> unidentified;
  for (const std::string& name : record.unidentified) {
    unidentified.push_back(yamlText(name));
  }
  writer.list(2, "unidentified", unidentified);
  if (record.validation) {
    writer.entry(2, "validation", validationLine(*record.validation));
  }
  writer.optional(2, "orientation_uncertainty", record.orientation_uncertainty);
  writer.optional(2, "torque_uncertainty", record.torque_uncertainty);
  if (record.orientation_map) {
    writer.entry(2, "orientation_map", mapLine(*record.orientation_map));
  }
  if (record.covariance) {
    writeCovariance(writer, *record.covariance);
  }
}

std::string inertiaLine(const Eigen::Matrix3d& J) {
  YamlLine line;
  line.add("xx", yamlNumber(J(0, 0))).add("yy", yamlNumber(J(1, 1))).add("zz", yamlNumber(J(2, 2)));
  line.add("xy", yamlNumber(J(0, 1))).add("xz", yamlNumber(J(0, 2))).add("yz", yamlNumber(J(1, 2)));
  return line.text();
}

std::string curveStddevLine(const TorqueCurveStddev& stddev) {
  return YamlLine()
      .add("angles", yamlNumbers(stddev.angles))
      .add("torques", yamlNumbers(stddev.torques))
      .text();
}

void writeDynamics(YamlWriter& writer, const Actuator& actuator, const ParameterStddevs& stddevs) {
  if (stddevs.unbalance || !actuator.unbalance.isZero(0.0)) {
    writer.entry(1, "rotor_unbalance", yamlNumbers(actuator.unbalance));
  }
  if (stddevs.unbalance) {
    writer.entry(1, "rotor_unbalance_stddev", yamlNumbers(*stddevs.unbalance));
  }
  if (actuator.inertia) {
    writer.entry(1, "rotor_inertia", inertiaLine(*actuator.inertia));
  }
  if (actuator.friction) {
    YamlLine friction;
    friction.add("viscous", yamlNumber(actuator.friction->viscous));
    friction.add("coulomb", yamlNumber(actuator.friction->coulomb));
    writer.entry(1, "rotor_friction", friction.text());
  }
}

}  // namespace

std::string renderDescription(const CalibratedDescription& description, const std::string& name) {
  const Actuator& actuator = description.actuator;
  YamlWriter writer;
  writer.map(0, "actuator");
  writer.entry(1, "name", yamlText(actuator.name));
  if (!actuator.serial.empty()) {
    writer.entry(1, "serial", yamlText(actuator.serial));
  }
  std::vector<std::string> joints;
  for (std::size_t k = 0; actuator.has_joints && k < kJoints; ++k) {
    joints.push_back(jointLine(actuator.joints[k], description.stddevs.joints[k]));
  }
  writer.list(1, "joints", joints);
  writeAxes(writer, "poles", actuator.poles, description.stddevs.poles, poleLine);
  writeAxes(writer, "coils", actuator.coils, description.stddevs.coils, coilLine);
  if (actuator.torque_curve) {
    writer.entry(1, "torque_curve", torqueCurveLine(*actuator.torque_curve));
  }
  if (description.stddevs.torque_curve) {
    writer.entry(1, "torque_curve_stddev", curveStddevLine(*description.stddevs.torque_curve));
  }
  YamlLine workspace;
  workspace.add("tilt_limit", yamlNumber(actuator.workspace.tilt_limit));
  writer.entry(1, "workspace", workspace.text());
  writeDynamics(writer, actuator, description.stddevs);
  if (actuator.orientation_map) {
    writeOrientationMap(writer, *actuator.orientation_map);
  }
  if (description.calibration) {
    writeCalibration(writer, *description.calibration);
  }
  // What cannot be loaded again must not be saved: the reader is the judge.
  parseDescription(writer.text(), name);
  return writer.text();
}

}  // namespace sac
