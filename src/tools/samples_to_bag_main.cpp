#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include <boost/program_options.hpp>
#include <rosbag/bag.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
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
  std::string ns;
  bool force = false;
};

std::optional<Options> parseOptions(int argc, char** argv) {
  namespace po = boost::program_options;
  Options options;
  po::options_description known("Options");
  known.add_options()(
      "actuator", po::value(&options.actuator_path)->required(), "actuator description (YAML)")(
      "samples", po::value(&options.samples_path)->required(), "measured samples (YAML)")(
      "output", po::value(&options.output_path)->required(), "recording to write (bag)")(
      "ns", po::value(&options.ns)->default_value("/actuator"), "namespace of the topics")(
      "force", po::bool_switch(&options.force), "replace the recording if it exists");
  if (!parseCommandLine(
          argc,
          argv,
          known,
          "Usage: samples_to_bag --actuator A.yaml --samples S.yaml --output OUT.bag\n\n"
          "Writes measured samples as the messages that calibrate_bag reads.\n")) {
    return std::nullopt;
  }
  return options;
}

void writeBag(const Options& options) {
  const Actuator actuator = loadActuator(options.actuator_path);
  const std::vector<Sample> samples = loadSamples(options.samples_path, actuator.coils.size());
  if (!options.force && std::filesystem::exists(options.output_path)) {
    throw DataError(options.output_path +
                    ": the file exists already; choose another name or give --force.");
  }
  const std::string active_path = options.output_path + ".active";
  rosbag::Bag bag(active_path, rosbag::bagmode::Write);
  ros::Time stamp(kFirstStamp);
  msg::ActuatorParameters parameters = parametersToRos(actuator);
  parameters.header.stamp = stamp;
  parameters.header.frame_id = "stator";
  parameters.source = "nominal";
  bag.write(options.ns + "/parameters", stamp, parameters);
  for (const Sample& sample : samples) {
    msg::CalibrationSample message = sampleToRos(sample);
    message.header.stamp = stamp;
    message.header.frame_id = "stator";
    bag.write(options.ns + "/samples", stamp, message);
    stamp += ros::Duration(kSampleSpacing);
  }
  bag.close();
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
