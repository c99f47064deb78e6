#include "spherical_actuator_calibration/planning/session_plan_file.hpp"

#include <limits>
#include <vector>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"

namespace sac {
namespace {

constexpr std::int64_t kMostOfAnything = 1'000'000;

std::string yamlVector(const Eigen::Vector3d& vector) {
  return yamlList({yamlNumber(vector[0]), yamlNumber(vector[1]), yamlNumber(vector[2])});
}

const char* yamlBoolean(bool value) {
  return value ? "true" : "false";
}

std::string poseLine(const PlannedPose& pose) {
  std::vector<std::string> coils;
  coils.reserve(pose.coils.size());
  for (const std::size_t coil : pose.coils) {
    coils.push_back(std::to_string(numberOf(coil)));
  }
  YamlLine line;
  line.add("joint_position", yamlVector(pose.joint_position));
  line.add("coils", yamlList(coils));
  return line.text();
}

std::string estimateLine(const ParameterEstimate& estimate) {
  YamlLine line;
  line.add("parameter", yamlText(estimate.name));
  line.add("value", yamlNumber(estimate.value));
  line.add("stddev", yamlNumber(estimate.stddev));
  line.add("observable", yamlBoolean(estimate.observable));
  return line.text();
}

Eigen::Vector3d readVector(const YamlMap& map, const std::string& key, const ValueRange& range) {
  return Eigen::Vector3d(map.numbers(key, range, 3).data());
}

std::size_t readCount(const YamlMap& map, const std::string& key) {
  return static_cast<std::size_t>(map.integer(key, 0, kMostOfAnything));
}

PlannedPose readPose(const YamlMap& map) {
  PlannedPose pose;
  pose.joint_position = readVector(map, "joint_position", ValueRange::finite("rad"));
  for (const double coil : map.numbers("coils", ValueRange::closed(1.0, kMostOfAnything))) {
    const auto number = static_cast<std::size_t>(coil);
    if (static_cast<double>(number) != coil) {
      map.fail("coils", "coils are whole numbers, counted from 1.");
    }
    pose.coils.push_back(indexOf(number).value());
  }
  return pose;
}

ParameterEstimate readEstimate(const YamlMap& map) {
  ParameterEstimate estimate;
  estimate.name = map.nonEmptyText("parameter");
  estimate.value = map.number("value", ValueRange::finite());
  estimate.stddev = map.number("stddev", ValueRange::nonNegative());
  estimate.observable = map.boolean("observable");
  return estimate;
}

void readAssumptions(const YamlMap& map, SessionPlanRecord& record) {
  record.current = map.number("current", ValueRange::positive("A"));
  record.tracker_on = map.boolean("tracker_on");
  record.joint_stddev = readVector(map, "joint_stddev", ValueRange::nonNegative("rad"));
  record.orientation_stddev = map.number("orientation_stddev", ValueRange::positive("rad"));
  record.torque_stddev = map.number("torque_stddev", ValueRange::positive("N m"));
  record.samples_held = readCount(map, "samples_held");
}

void readExpectations(const YamlMap& map, PosePlan& plan) {
  plan.message = map.text("message");
  plan.orientation_samples = readCount(map, "orientation_samples");
  plan.torque_samples = readCount(map, "torque_samples");
  plan.travel = map.number("travel", ValueRange::nonNegative("rad"));
  plan.worst_parameter = map.text("worst_parameter");
  plan.worst_stddev = map.number("worst_stddev", ValueRange::nonNegative());
  plan.orientation_uncertainty =
      map.number("orientation_uncertainty", ValueRange::nonNegative("rad"));
  plan.torque_uncertainty = map.number("torque_uncertainty", ValueRange::nonNegative("N m/A"));
  plan.reached_wanted = map.boolean("reached_wanted");
  if (map.has("poses_needed")) {
    plan.poses_needed = readCount(map, "poses_needed");
  }
  for (const YamlMap& estimate : map.maps("parameters")) {
    plan.expected.push_back(readEstimate(estimate));
  }
}

}  // namespace

std::string renderSessionPlan(const SessionPlanRecord& record) {
  const PosePlan& plan = record.plan;
  std::string text = "session_plan:\n";
  const auto add = [&text](const char* indent, const char* key, const std::string& value) {
    text += std::string(indent) + key + ": " + value + "\n";
  };
  add("  ", "actuator", yamlText(record.actuator));
  add("  ", "serial", yamlText(record.serial));
  add("  ", "software", yamlText(record.software));
  add("  ", "cycle", yamlText(record.cycle));
  text += "  assumed:\n";
  add("    ", "current", yamlNumber(record.current));
  add("    ", "tracker_on", yamlBoolean(record.tracker_on));
  add("    ", "joint_stddev", yamlVector(record.joint_stddev));
  add("    ", "orientation_stddev", yamlNumber(record.orientation_stddev));
  add("    ", "torque_stddev", yamlNumber(record.torque_stddev));
  add("    ", "samples_held", std::to_string(record.samples_held));
  text += "  # in the order to be visited: sensor angles [rad], coils to excite in turn\n  poses:";
  text += plan.poses.empty() ? " []\n" : "\n";
  for (const PlannedPose& pose : plan.poses) {
    text += "    - " + poseLine(pose) + "\n";
  }
  text += "  expected:\n";
  add("    ", "message", yamlText(plan.message));
  add("    ", "orientation_samples", std::to_string(plan.orientation_samples));
  add("    ", "torque_samples", std::to_string(plan.torque_samples));
  add("    ", "travel", yamlNumber(plan.travel));
  add("    ", "worst_parameter", yamlText(plan.worst_parameter));
  add("    ", "worst_stddev", yamlNumber(plan.worst_stddev));
  add("    ", "orientation_uncertainty", yamlNumber(plan.orientation_uncertainty));
  add("    ", "torque_uncertainty", yamlNumber(plan.torque_uncertainty));
  add("    ", "reached_wanted", yamlBoolean(plan.reached_wanted));
  if (plan.poses_needed) {
    add("    ", "poses_needed", std::to_string(*plan.poses_needed));
  }
  text += "    parameters:\n";
  for (const ParameterEstimate& estimate : plan.expected) {
    text += "      - " + estimateLine(estimate) + "\n";
  }
  return text;
}

SessionPlanRecord loadSessionPlan(const std::string& path) {
  const YamlMap file = YamlMap::load(path);
  const YamlMap map = file.map("session_plan");
  SessionPlanRecord record;
  record.actuator = map.nonEmptyText("actuator");
  record.serial = map.text("serial", "");
  record.software = map.text("software", "");
  record.cycle = map.nonEmptyText("cycle");
  readAssumptions(map.map("assumed"), record);
  for (const YamlMap& pose : map.maps("poses")) {
    record.plan.poses.push_back(readPose(pose));
  }
  readExpectations(map.map("expected"), record.plan);
  record.plan.success = true;
  file.finish();
  return record;
}

SessionPlan sessionOf(const SessionPlanRecord& record, const Actuator& actuator) {
  if (record.actuator != actuator.name) {
    throw ConfigError("The session plan is for the actuator " + record.actuator + ", not for " +
                      actuator.name + ".");
  }
  if (!record.serial.empty() && !actuator.serial.empty() && record.serial != actuator.serial) {
    throw ConfigError("The session plan is for the unit " + record.serial + ", not for " +
                      actuator.serial + ".");
  }
  const auto coils = static_cast<Eigen::Index>(actuator.coils.size());
  SessionPlan session;
  for (const PlannedPose& pose : record.plan.poses) {
    PlannedDwell dwell;
    dwell.joint_position = pose.joint_position;
    for (const std::size_t coil : pose.coils) {
      if (coil >= actuator.coils.size()) {
        throw ConfigError("The session plan excites coil " + std::to_string(numberOf(coil)) +
                          ", but coils count from 1 to " + std::to_string(coils) + ".");
      }
      dwell.patterns.emplace_back(record.current *
                                  Eigen::VectorXd::Unit(coils, static_cast<Eigen::Index>(coil)));
    }
    session.dwells.push_back(dwell);
  }
  return session;
}

}  // namespace sac
