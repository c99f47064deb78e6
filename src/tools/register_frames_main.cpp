#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <ros/init.h>

#include "command_line.hpp"
#include "register_frames_live.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "spherical_actuator_calibration/ros/recording/tracked_pose_streams.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

constexpr int kRefused = 1;
constexpr char kIntroduction[] =
    "Usage: register_frames [--actuator A.yaml] [--output FRAMES.yaml] [BAG...]\n\n"
    "Finds where tracker and marker sit, stator_tracker and rotor_marker of lab.launch, from "
    "poses\n"
    "of the rotor: of the topics joint_states and tracker/pose of recordings, or without one, of\n"
    "those topics live, while the rotor is turned by hand or by its coils and rests now and then.\n"
    "The result is in the frames of the description's joints; what that is worth is printed with "
    "it\n"
    "(doc/registration.md).\n"
    "Exit status: 0 registered; 1 the poses do not tell it, and what to do; 2 bad usage or "
    "unreadable\n"
    "input.\n\n";

struct Options {
  std::optional<std::string> actuator_path;
  std::optional<std::string> config_path;
  std::optional<std::string> samples_path;
  std::optional<std::string> output_path;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
  LiveRegistrationOptions live;
  std::vector<std::string> bags;
  bool isLive() const { return bags.empty() && !samples_path; }
};

std::optional<Options> parseOptions(int argc, char** argv) {
  std::vector<std::string> words;
  ros::removeROSArgs(argc, argv, words);
  std::vector<const char*> arguments;
  arguments.reserve(words.size());
  for (const std::string& word : words) {
    arguments.push_back(word.c_str());
  }
  Options options;
  CommandLine line(kIntroduction);
  line.addInput("actuator",
                options.actuator_path,
                "YAML",
                "description, of the drawing or calibrated; live: that of the parameter server");
  line.addInput("config",
                options.config_path,
                "YAML",
                "configuration: dwell, means, estimation, tolerance (config/calibration.yaml)");
  line.addOutput(
      "output", options.output_path, "YAML", "the registration with its covariance to write");
  line.addInput("samples",
                options.samples_path,
                "YAML",
                "instead of a recording: samples whose orientation is the marker's in the tracker");
  line.add("ns", options.live.ns, "NAME", "namespace of the actuator's topics");
  line.add("poses", options.live.poses, "COUNT", "live: so many different poses are enough");
  line.add("duration", options.live.duration, "s", "live: over which a pose is averaged");
  line.addForce(options.overwrite);
  line.addInputs(options.bags, "BAG");
  if (!line.parse(static_cast<int>(arguments.size()), arguments.data(), std::cout)) {
    return std::nullopt;
  }
  if (options.samples_path && !options.bags.empty()) {
    throw ConfigError("--samples: give recordings or samples, not both.");
  }
  if (!options.isLive() && !options.actuator_path) {
    throw ConfigError("--actuator: a recording needs the description of its actuator.");
  }
  if (options.live.poses < kLeastRegistrationPoses) {
    throw ConfigError("--poses: at least " + std::to_string(kLeastRegistrationPoses) + ".");
  }
  if (!(options.live.duration > 0.0 &&
        options.live.duration < SampleBuilderOptions().largest_dwell)) {
    throw ConfigError("--duration: more than 0 s, and less than the longest dwell.");
  }
  return options;
}

std::vector<TrackedPose> posesOf(const Options& options,
                                 const CalibratedDescription& description,
                                 const CalibrationConfig& config) {
  if (options.samples_path) {
    return trackedPoses(loadSamples(*options.samples_path, description.actuator.coils.size()));
  }
  if (options.isLive()) {
    return takePosesLive(description, config, options.live);
  }
  const RecordedPoses recorded = readTrackedPoses(options.bags,
                                                  description.actuator,
                                                  options.live.ns,
                                                  config.samples,
                                                  terminalProgress("reading"));
  for (const std::string& note : recorded.notes) {
    std::printf("%s\n", note.c_str());
  }
  return recorded.poses;
}

/// "12.3 12.0 15.1"
std::string milliradians(const FrameRegistration::Covariance& covariance, Eigen::Index first) {
  constexpr double kPerRadian = 1e3;
  const Eigen::Vector3d stddev = kPerRadian * covariance.diagonal().segment<3>(first).cwiseSqrt();
  return format("%.2f %.2f %.2f", stddev[0], stddev[1], stddev[2]);
}

void printFrame(const char* name,
                const Eigen::Matrix3d& rotation,
                const FrameRegistration& registration,
                Eigen::Index first) {
  std::printf("%s: %s\n    +- %s mrad about x, y, z of the %s; of it the poses' noise +- %s mrad\n",
              name,
              launchArgument(rotation).c_str(),
              milliradians(registration.covariance, first).c_str(),
              first == 0 ? "stator" : "rotor",
              milliradians(registration.noise_covariance, first).c_str());
}

void print(const FrameRegistration& registration) {
  std::printf("%s\n", registration.message.c_str());
  for (const std::string& note : registration.notes) {
    std::printf("%s\n", note.c_str());
  }
  if (!registration.success) {
    return;
  }
  printFrame("stator_tracker", registration.R_stator_tracker, registration, 0);
  printFrame("rotor_marker", registration.R_rotor_marker, registration, 3);
  std::printf(
      "The rest of +- is what the description leaves open of the joints. The translations, 0 "
      "0 0, move\npictures only: measure them where those matter.\n\n"
      "roslaunch spherical_actuator_calibration lab.launch \\\n"
      "  stator_tracker:=\"%s\" \\\n  rotor_marker:=\"%s\" \\\n"
      "  tracker_and_marker_covariance:=\"%s\"\n\n"
      "The last one is, in the configuration of a calibration:\n\n"
      "registration:\n  tracker_and_marker:\n    covariance: %s\n",
      launchArgument(registration.R_stator_tracker).c_str(),
      launchArgument(registration.R_rotor_marker).c_str(),
      covarianceArgument(registration).c_str(),
      covarianceArgument(registration).c_str());
}

int registerOnce(const Options& options) {
  if (options.output_path) {
    requireNewFile(*options.output_path, options.overwrite);
  }
  const CalibratedDescription description = options.actuator_path
                                                ? loadDescription(*options.actuator_path)
                                                : describedActuator(options.live.ns);
  requireJoints(description);
  const CalibrationConfig config =
      options.config_path ? loadCalibrationConfig(*options.config_path) : CalibrationConfig();
  const FrameRegistration registration =
      registerFrames(description, posesOf(options, description, config), config.estimation);
  print(registration);
  if (!registration.success) {
    return kRefused;
  }
  if (options.output_path) {
    saveFrameRegistration(
        *options.output_path, description.actuator, registration, options.overwrite);
  }
  return kToolSuccess;
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("register_frames", [&] {
    const auto options = sac::parseOptions(argc, argv);
    if (!options) {
      return sac::kToolSuccess;
    }
    if (options->isLive()) {
      sac::initializeRos(argc, argv);
    }
    return sac::registerOnce(*options);
  });
}
