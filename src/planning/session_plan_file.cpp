#include "spherical_actuator_calibration/planning/session_plan_file.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <sstream>
#include <system_error>
#include <vector>

#include "spherical_actuator_calibration/actuator/unit_identity.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/planning/session_plan_record.hpp"

namespace sac {
namespace {

constexpr std::int64_t kMostOfAnything = 1'000'000;

std::string poseLine(const PlannedPose& pose) {
  std::vector<std::string> coils;
  coils.reserve(pose.coils.size());
  for (const std::size_t coil : pose.coils) {
    coils.push_back(std::to_string(numberOf(coil)));
  }
  YamlLine line;
  line.add("joint_position", yamlNumbers(pose.joint_position));
  line.add("coils", yamlList(coils));
  if (!pose.patterns.empty()) {
    std::vector<std::string> patterns;
    patterns.reserve(pose.patterns.size());
    for (const CoilPattern& pattern : pose.patterns) {
      patterns.push_back('"' + patternText(pattern) + '"');
    }
    line.add("patterns", yamlList(patterns));
  }
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

/// "+1 -4": coil 1 at +current, coil 4 at −current, at once.
CoilPattern readPattern(const YamlMap& map, const std::string& text) {
  CoilPattern pattern;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::size_t number = 0;
    const char* end = word.data() + word.size();
    const auto [last, error] = std::from_chars(word.data() + 1, end, number);
    const bool has_sign = word.front() == '+' || word.front() == '-';
    if (!has_sign || error != std::errc{} || last != end || number == 0 ||
        number > kMostOfAnything) {
      map.fail("patterns", "\"" + excerpt(text) + "\" is no pattern such as \"+1 -4\".");
    }
    const std::size_t coil = indexOf(number).value();
    if (!pattern.empty() && coil <= pattern.back().coil) {
      map.fail("patterns", "\"" + excerpt(text) + "\": coils ascend, each at most once.");
    }
    pattern.push_back({coil, word.front() == '-' ? -1 : 1});
  }
  return pattern;
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
  if (map.has("patterns")) {
    for (const std::string& text : map.texts("patterns")) {
      pose.patterns.push_back(readPattern(map, text));
      for (const SignedCoil& coil : pose.patterns.back()) {
        if (std::find(pose.coils.begin(), pose.coils.end(), coil.coil) == pose.coils.end()) {
          map.fail("patterns",
                   "\"" + excerpt(text) + "\" excites a coil that is not among the coils.");
        }
      }
    }
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
  if (map.has("stddev_bound")) {
    plan.stddev_bound = map.number("stddev_bound", ValueRange::nonNegative());
  }
  plan.reached_wanted = map.boolean("reached_wanted");
  if (map.has("poses_needed")) {
    plan.poses_needed = readCount(map, "poses_needed");
  }
  for (const YamlMap& estimate : map.maps("parameters")) {
    plan.expected.push_back(readEstimate(estimate));
  }
}

void writeAssumptions(YamlWriter& writer, const SessionPlanRecord& record) {
  writer.map(1, "assumed");
  writer.entry(2, "current", yamlNumber(record.current));
  writer.entry(2, "tracker_on", yamlBoolean(record.tracker_on));
  writer.entry(2, "joint_stddev", yamlNumbers(record.joint_stddev));
  writer.entry(2, "orientation_stddev", yamlNumber(record.orientation_stddev));
  writer.entry(2, "torque_stddev", yamlNumber(record.torque_stddev));
  writer.entry(2, "samples_held", std::to_string(record.samples_held));
}

void writeExpectations(YamlWriter& writer, const PosePlan& plan) {
  std::vector<std::string> estimates;
  for (const ParameterEstimate& estimate : plan.expected) {
    estimates.push_back(estimateLine(estimate));
  }
  writer.map(1, "expected");
  writer.entry(2, "message", yamlText(plan.message));
  writer.entry(2, "orientation_samples", std::to_string(plan.orientation_samples));
  writer.entry(2, "torque_samples", std::to_string(plan.torque_samples));
  writer.entry(2, "travel", yamlNumber(plan.travel));
  writer.entry(2, "worst_parameter", yamlText(plan.worst_parameter));
  writer.entry(2, "worst_stddev", yamlNumber(plan.worst_stddev));
  writer.entry(2, "orientation_uncertainty", yamlNumber(plan.orientation_uncertainty));
  writer.entry(2, "torque_uncertainty", yamlNumber(plan.torque_uncertainty));
  if (plan.stddev_bound) {
    writer.entry(2, "stddev_bound", yamlNumber(*plan.stddev_bound));
  }
  writer.entry(2, "reached_wanted", yamlBoolean(plan.reached_wanted));
  if (plan.poses_needed) {
    writer.entry(2, "poses_needed", std::to_string(*plan.poses_needed));
  }
  writer.list(2, "parameters", estimates);
}

}  // namespace

std::string renderSessionPlan(const SessionPlanRecord& record) {
  YamlWriter writer;
  writer.map(0, "session_plan");
  writer.entry(1, "actuator", yamlText(record.actuator));
  writer.entry(1, "serial", yamlText(record.serial));
  writer.entry(1, "software", yamlText(record.software));
  writer.entry(1, "cycle", yamlText(record.cycle));
  writeAssumptions(writer, record);
  std::vector<std::string> poses;
  for (const PlannedPose& pose : record.plan.poses) {
    poses.push_back(poseLine(pose));
  }
  writer.line(
      1, "# in the order to be visited: sensor angles [rad], coils to excite in turn, or patterns");
  writer.list(1, "poses", poses);
  writeExpectations(writer, record.plan);
  return writer.text();
}

SessionPlanRecord loadSessionPlan(const std::string& path) {
  const YamlMap file = YamlMap::parse(readInputFile(path, kLargestConfiguration), path);
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

namespace {

void requireUnit(const SessionPlanRecord& record, const Actuator& actuator) {
  if (const auto other = otherUnit(actuator, record.actuator, record.serial)) {
    throw ConfigError("it is for the " + other->kind + " " + other->its + ", not for " +
                      other->own + ".");
  }
}

void requireCoils(const PlannedPose& pose, std::size_t coils) {
  for (const CoilPattern& pattern : pose.excitations()) {
    for (const SignedCoil& coil : pattern) {
      if (coil.coil >= coils) {
        throw ConfigError("it excites coil " + std::to_string(numberOf(coil.coil)) + " of the " +
                          std::to_string(coils) + " that there are.");
      }
    }
  }
}

void requireSuits(const SessionPlanRecord& record, const Actuator& actuator) {
  requireUnit(record, actuator);
  if (record.plan.poses.empty()) {
    throw ConfigError("it has no pose.");
  }
  for (std::size_t n = 0; n < record.plan.poses.size(); ++n) {
    try {
      requireInWorkspace(record.plan.poses[n].joint_position, actuator.workspace);
      requireCoils(record.plan.poses[n], actuator.coils.size());
    } catch (const ConfigError& error) {
      throw ConfigError("pose " + std::to_string(numberOf(n)) + ": " + error.what());
    }
  }
}

}  // namespace

SessionPlanRecord loadSessionPlanFor(const Actuator& actuator, const std::string& path) {
  SessionPlanRecord record = loadSessionPlan(path);
  try {
    requireSuits(record, actuator);
  } catch (const ConfigError& error) {
    throw ConfigError(path + ": " + error.what());
  }
  return record;
}

SessionPlan loadPlannedSession(const std::string& path, const Actuator& actuator) {
  const SessionPlanRecord record = loadSessionPlanFor(actuator, path);
  const auto coils = static_cast<Eigen::Index>(actuator.coils.size());
  SessionPlan session;
  for (const PlannedPose& pose : record.plan.poses) {
    PlannedDwell dwell;
    dwell.joint_position = pose.joint_position;
    for (const CoilPattern& pattern : pose.excitations()) {
      Eigen::VectorXd currents = Eigen::VectorXd::Zero(coils);
      for (const SignedCoil& signed_coil : pattern) {
        currents[static_cast<Eigen::Index>(signed_coil.coil)] = signed_coil.sign * record.current;
      }
      dwell.patterns.push_back(currents);
    }
    session.dwells.push_back(dwell);
  }
  return session;
}

}  // namespace sac
