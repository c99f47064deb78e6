#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <rosbag/bag.h>

#include "command_line.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/topic_names.hpp"
#include "spherical_actuator_calibration/ros/recording/bag_closing.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

/// Stamp of the first sample, and the time from one to the next [s]: measurements that were written
/// down have no clock, and a recording needs one that grows.
constexpr double kFirstStamp = 1.0;
constexpr double kSampleSpacing = 1.0;

struct Options {
  std::string actuator_path;
  std::string samples_path;
  std::string output_path;
  std::string ns = "/actuator";
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
};

std::optional<Options> parseOptions(int argc, char** argv) {
  Options options;
  CommandLine line(
      "Usage: samples_to_bag --actuator A.yaml --samples S.yaml --output OUT.bag\n\n"
      "Writes measured samples as the messages that calibrate_bag reads.\n\n");
  line.addRequiredInput("actuator", options.actuator_path, "YAML", "actuator description");
  line.addRequiredInput("samples", options.samples_path, "YAML", "measured samples");
  line.addRequiredOutput("output", options.output_path, "BAG", "recording to write");
  line.add("ns", options.ns, "NAME", "namespace of the topics");
  line.addForce(options.overwrite);
  if (!line.parse(argc, argv, std::cout)) {
    return std::nullopt;
  }
  line.requireSeparate("output", options.output_path + ".active");
  return options;
}

void writeSamples(const Options& options,
                  const Actuator& actuator,
                  const std::vector<Sample>& samples,
                  rosbag::Bag& bag) {
  ros::Time stamp(kFirstStamp);
  msg::ActuatorParameters parameters = parametersToRos(actuator);
  parameters.header.stamp = stamp;
  parameters.header.frame_id = "stator";
  parameters.source = "nominal";
  const std::string prefix = topicPrefix(options.ns);
  bag.write(prefix + "parameters", stamp, parameters);
  for (const Sample& sample : samples) {
    msg::CalibrationSample message = sampleToRos(sample);
    message.header.stamp = stamp;
    message.header.frame_id = "stator";
    bag.write(prefix + "samples", stamp, message);
    stamp += ros::Duration(kSampleSpacing);
  }
}

void writeBag(const Options& options) {
  const Actuator actuator = loadActuator(options.actuator_path);
  const std::vector<Sample> samples =
      loadSamples(options.samples_path, actuator.coils.size(), actuator.has_joints);
  requireNewFile(options.output_path, options.overwrite);
  const std::string active_path = options.output_path + ".active";
  auto bag = std::make_unique<rosbag::Bag>();
  try {
    bag->open(active_path, rosbag::bagmode::Write);
    writeSamples(options, actuator, samples, *bag);
    bag->close();
  } catch (const std::exception& error) {
    closeBag(bag);
    std::error_code ignored;
    std::filesystem::remove(active_path, ignored);
    throw DataError(options.output_path + ": cannot be written: " + error.what() + ".");
  }
  std::filesystem::rename(active_path, options.output_path);
  std::printf("%s: %zu samples\n", options.output_path.c_str(), samples.size());
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("samples_to_bag", [&] {
    const auto options = sac::parseOptions(argc, argv);
    if (options) {
      sac::writeBag(*options);
    }
    return sac::kToolSuccess;
  });
}
