#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "command_line.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/csv_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/calibration/prediction.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

constexpr std::size_t kMostLines = 10'000'000;
constexpr char kIntroduction[] =
    "Usage: predict --actuator CALIBRATED.yaml --joints q.csv --output r.csv [--currents i.csv]\n"
    "       predict --actuator CALIBRATED.yaml --orientations q.csv --currents i.csv --output "
    "r.csv\n\n"
    "Tells by a description where the rotor is at joint sensor angles, with everything that was\n"
    "identified: for each line q1,q2,q3 [rad] a line qx,qy,qz,qw,stddev, the unit quaternion that\n"
    "rotates rotor coordinates into stator coordinates and the standard deviation of each "
    "component\n"
    "of its rotation error [rad]. With --currents, a line of as many currents [A] as coils for "
    "each\n"
    "pose, also the torque of the coils on the rotor in the rotor's frame [N.m] and the standard\n"
    "deviation of each component: tx,ty,tz,torque_stddev. A first line of names in --joints gets\n"
    "one in the output. A machine of two joints has 0 for the third.\n"
    "For a rotor without joints a line qx,qy,qz,qw, what the tracker measures, and its currents\n"
    "become a line tx,ty,tz,torque_stddev.\n"
    "Exit status: 0 done; 2 bad usage or unreadable input.\n\n";

struct Options {
  std::string actuator_path;
  std::optional<std::string> joints_path;
  std::optional<std::string> orientations_path;
  std::string output_path;
  std::optional<std::string> currents_path;
  bool has_load = false;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
};

std::optional<Options> parseOptions(int argc, char** argv) {
  Options options;
  CommandLine line(kIntroduction);
  line.addRequiredInput(
      "actuator", options.actuator_path, "YAML", "description, usually a calibrated one");
  line.addInput("joints", options.joints_path, "CSV", "joint sensor angles [rad], a pose a line");
  line.addInput("orientations",
                options.orientations_path,
                "CSV",
                "orientations of a rotor without joints, a unit quaternion a line");
  line.addRequiredOutput(
      "output", options.output_path, "CSV", "orientations (and torques) to write");
  line.addInput(
      "currents", options.currents_path, "CSV", "coil currents [A], a line for each pose");
  line.addSwitch("unbalance",
                 options.has_load,
                 "add the weight of an unbalanced rotor to the torque, which takes --currents");
  line.addForce(options.overwrite);
  if (!line.parse(argc, argv, std::cout)) {
    return std::nullopt;
  }
  return options;
}

const std::string& posesPath(const Options& options) {
  return options.joints_path ? *options.joints_path : *options.orientations_path;
}

/// Refuses what the description has no use for.
void requireFitting(const Options& options, bool has_joints) {
  if (options.joints_path.has_value() == options.orientations_path.has_value()) {
    throw ConfigError("Give one of --joints and --orientations.");
  }
  if (has_joints != options.joints_path.has_value()) {
    throw ConfigError(options.actuator_path +
                      (has_joints ? ": the rotor has joints; give their angles by --joints."
                                  : ": the rotor has no joints; give its orientations by "
                                    "--orientations."));
  }
  if (options.has_load && !options.currents_path) {
    throw ConfigError("--unbalance belongs to torques; give --currents, too.");
  }
  if (!has_joints && !options.currents_path) {
    throw ConfigError(options.actuator_path +
                      ": of a rotor without joints only the torque can be predicted; give "
                      "--currents.");
  }
}

/// What the model reads of a line: joint angles, or those that stand for a quaternion.
Eigen::Vector3d readingOf(const CsvRow& row, bool has_joints) {
  if (has_joints) {
    row.requireColumns(kJoints);
    return Eigen::Vector3d(row.values.data());
  }
  constexpr std::size_t kQuaternion = 4;
  row.requireColumns(kQuaternion);
  try {
    return freeRotorAngles(Eigen::Quaterniond(Eigen::Vector4d(row.values.data())));
  } catch (const DataError& error) {
    throw DataError(row.place + ": " + error.what());
  }
}

/// Currents of each pose; none where none are asked for.
std::optional<CsvFile> readCurrents(const Options& options,
                                    const Predictor& predictor,
                                    std::size_t poses) {
  if (!options.currents_path) {
    return std::nullopt;
  }
  if (!predictor.hasTorqueModel()) {
    throw ConfigError(options.actuator_path +
                      ": without poles, coils and torque curve no torque can be predicted; leave "
                      "--currents out.");
  }
  CsvFile currents = loadCsv(*options.currents_path, kMostLines);
  for (const CsvRow& row : currents.rows) {
    row.requireColumns(predictor.coils());
  }
  if (currents.rows.size() != poses) {
    throw ConfigError(*options.currents_path + ": " + std::to_string(currents.rows.size()) +
                      " lines of currents for " + std::to_string(poses) + " poses of " +
                      posesPath(options) + "; each pose needs one.");
  }
  return currents;
}

template <typename Values>
void append(const Values& values, std::string& text) {
  for (const double value : values) {
    text += shortestText(value) + ",";
  }
}

/// Tells which lines no map supports.
void tellUnsupported(const std::vector<std::string>& places, std::size_t poses) {
  if (!places.empty()) {
    std::printf(
        "%zu of %zu poses lie away from the points of the orientation map; joint axes and "
        "corrections alone tell the orientation there, from %s to %s.\n",
        places.size(),
        poses,
        places.front().c_str(),
        places.back().c_str());
  }
}

std::string heading(bool has_joints, bool has_currents) {
  const std::string torque = "tx,ty,tz,torque_stddev";
  if (!has_joints) {
    return torque + "\n";
  }
  return "qx,qy,qz,qw,stddev" + (has_currents ? "," + torque : "") + "\n";
}

void appendTorque(const Predictor::Torque& torque, std::string& text) {
  append(torque.torque, text);
  text += shortestText(torque.stddev);
}

void predict(const Options& options) {
  const CalibratedDescription description = loadDescription(options.actuator_path);
  const bool has_joints = description.actuator.has_joints;
  requireFitting(options, has_joints);
  const Predictor predictor(description);
  const CsvFile poses = loadCsv(posesPath(options), kMostLines);
  const std::optional<CsvFile> currents = readCurrents(options, predictor, poses.rows.size());
  requireNewFile(options.output_path, options.overwrite);
  std::string text = poses.has_heading ? heading(has_joints, currents.has_value()) : "";
  std::vector<std::string> unsupported;
  for (std::size_t n = 0; n < poses.rows.size(); ++n) {
    const CsvRow& row = poses.rows[n];
    const Eigen::Vector3d reading = readingOf(row, has_joints);
    if (has_joints) {
      const Predictor::Orientation pose = predictor.orientation(reading);
      append(Eigen::Quaterniond(pose.R_stator_rotor).normalized().coeffs(), text);
      text += shortestText(pose.stddev) + (currents ? "," : "");
      if (!pose.is_supported) {
        unsupported.push_back(row.place);
      }
    }
    if (currents) {
      const std::vector<double>& values = currents->rows[n].values;
      const Eigen::VectorXd current = Eigen::Map<const Eigen::VectorXd>(
          values.data(), static_cast<Eigen::Index>(values.size()));
      appendTorque(options.has_load ? predictor.loadedTorque(reading, current)
                                    : predictor.torque(reading, current),
                   text);
    }
    text += "\n";
  }
  writeFileAtomically(options.output_path, text, options.overwrite);
  if (!predictor.hasUncertainty()) {
    std::printf("%s states no uncertainty of its parameters: their part of stddev is 0.\n",
                options.actuator_path.c_str());
  }
  if (isContradicted(description)) {
    std::printf(
        "%s was contradicted by what was held out when it was made: do not use it, calibrate "
        "anew.\n",
        options.actuator_path.c_str());
  }
  tellUnsupported(unsupported, poses.rows.size());
  std::printf("%s: %zu poses\n", options.output_path.c_str(), poses.rows.size());
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("predict", [&] {
    const auto options = sac::parseOptions(argc, argv);
    if (options) {
      sac::predict(*options);
    }
    return sac::kToolSuccess;
  });
}
