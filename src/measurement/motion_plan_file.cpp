#include "spherical_actuator_calibration/measurement/motion_plan_file.hpp"

#include <cstddef>

#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"

namespace sac {
namespace {

void addSines(YamlLine& line, const std::vector<Sine>& sines) {
  std::vector<double> frequencies;
  std::vector<double> amplitudes;
  std::vector<double> phases;
  for (const Sine& sine : sines) {
    frequencies.push_back(sine.frequency);
    amplitudes.push_back(sine.amplitude);
    phases.push_back(sine.phase);
  }
  line.add("frequencies", yamlNumbers(frequencies));
  line.add("amplitudes", yamlNumbers(amplitudes));
  line.add("phases", yamlNumbers(phases));
}

std::vector<Sine> readSines(const YamlMap& map) {
  const std::vector<double> frequencies = map.numbers("frequencies", ValueRange::positive("Hz"));
  const std::vector<double> amplitudes =
      map.numbers("amplitudes", ValueRange::nonNegative(), frequencies.size());
  const std::vector<double> phases =
      map.numbers("phases", ValueRange::finite("rad"), frequencies.size());
  std::vector<Sine> sines;
  sines.reserve(frequencies.size());
  for (std::size_t n = 0; n < frequencies.size(); ++n) {
    sines.push_back({frequencies[n], amplitudes[n], phases[n]});
  }
  return sines;
}

void writeLimits(YamlWriter& writer, const MotionLimits& limits) {
  writer.map(1, "limits");
  writer.line(
      2, "# [rad] of joints 1 and 2, [rad/s] of each joint, [rad] between rotor and reference");
  writer.entry(2, "tilt", yamlNumber(limits.tilt));
  writer.entry(2, "rate", yamlNumber(limits.rate));
  writer.entry(2, "error", yamlNumber(limits.error));
  writer.line(
      2, "# [A] of a coil, [A] of the sum of all |currents|, [A2] of the sum of their squares");
  writer.entry(2, "coil_current", yamlNumber(limits.coil_current));
  writer.entry(2, "total_current", yamlNumber(limits.total_current));
  writer.entry(2, "square_current", yamlNumber(limits.square_current));
}

MotionLimits readLimits(const YamlMap& map) {
  MotionLimits limits;
  limits.tilt = map.number("tilt", ValueRange::positive("rad"));
  limits.rate = map.number("rate", ValueRange::positive("rad/s"));
  limits.error = map.number("error", ValueRange::positive("rad"));
  limits.coil_current = map.number("coil_current", ValueRange::positive("A"));
  limits.total_current = map.number("total_current", ValueRange::positive("A"));
  limits.square_current = map.number("square_current", ValueRange::positive("A2"));
  return limits;
}

}  // namespace

std::string renderMotionPlan(const MotionPlanRecord& record) {
  const MotionPlan& plan = record.plan;
  YamlWriter writer;
  writer.map(0, "motion_plan");
  writer.entry(1, "actuator", yamlText(plan.actuator));
  writer.entry(1, "serial", yamlText(plan.serial));
  writer.entry(1, "software", yamlText(record.software));
  writer.line(1, "# [s] with both ramps, in which its time gathers and loses speed");
  writer.entry(1, "duration", yamlNumber(plan.duration));
  writer.entry(1, "ramp", yamlNumber(plan.ramp));
  writeLimits(writer, plan.limits);
  std::vector<std::string> joints;
  for (const JointMotion& joint : plan.joints) {
    YamlLine line;
    line.add("centre", yamlNumber(joint.centre));
    addSines(line, joint.sines);
    joints.push_back(line.text());
  }
  writer.line(1,
              "# sensor angle = centre + sum of amplitude * sin(2 pi * frequency * t + phase): "
              "[rad], [Hz]");
  writer.list(1, "joints", joints);
  std::vector<std::string> coils;
  for (const std::vector<Sine>& sines : plan.coils) {
    YamlLine line;
    addSines(line, sines);
    coils.push_back(line.text());
  }
  writer.line(1, "# excitation of each coil likewise [A], before its torque is taken out");
  writer.list(1, "coils", coils);
  std::vector<std::string> expected;
  for (const ExpectedStddev& parameter : record.expected) {
    YamlLine line;
    line.add("parameter", yamlText(parameter.parameter));
    line.add("stddev", yamlNumber(parameter.stddev));
    expected.push_back(line.text());
  }
  writer.line(1,
              "# standard deviations that calibration from this motion is expected to reach [rad]");
  writer.list(1, "expected", expected);
  return writer.text();
}

MotionPlanRecord parseMotionPlan(const std::string& text, const std::string& name) {
  const YamlMap file = YamlMap::parse(text, name);
  const YamlMap map = file.map("motion_plan");
  MotionPlanRecord record;
  MotionPlan& plan = record.plan;
  plan.actuator = map.nonEmptyText("actuator");
  plan.serial = map.text("serial", "");
  record.software = map.text("software", "");
  plan.duration = map.number("duration", ValueRange::positive("s"));
  plan.ramp = map.number("ramp", ValueRange::positive("s"));
  plan.limits = readLimits(map.map("limits"));
  const std::vector<YamlMap> joints = map.maps("joints");
  if (joints.size() != kJoints) {
    map.fail("joints", "has not three entries.");
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    plan.joints[k].centre = joints[k].number("centre", ValueRange::finite("rad"));
    plan.joints[k].sines = readSines(joints[k]);
  }
  for (const YamlMap& coil : map.maps("coils")) {
    plan.coils.push_back(readSines(coil));
  }
  if (map.has("expected")) {
    for (const YamlMap& entry : map.maps("expected")) {
      record.expected.push_back({entry.nonEmptyText("parameter"),
                                 entry.number("stddev", ValueRange::nonNegative("rad"))});
    }
  }
  file.finish();
  return record;
}

}  // namespace sac
