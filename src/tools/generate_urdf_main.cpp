#include <iostream>
#include <optional>
#include <string>

#include "command_line.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/urdf_generator.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

struct Options {
  std::string actuator_path;
  std::optional<std::string> dimensions_path;  ///< nothing: the paper's
  std::optional<std::string> output_path;      ///< nothing: standard output
  std::string frame_prefix;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
};

std::optional<Options> parseOptions(int argc, char** argv) {
  Options options;
  CommandLine line(
      "Usage: generate_urdf --actuator A.yaml [--output U.urdf]\n\n"
      "Writes the robot description of an actuator, with any number of poles and coils.\n\n");
  line.addRequiredInput("actuator", options.actuator_path, "YAML", "actuator description");
  line.addInput("dimensions",
                options.dimensions_path,
                "YAML",
                "sizes, materials and limits; every key in config/actuator_dimensions.yaml");
  line.addOutput("output",
                 options.output_path,
                 "URDF",
                 "robot description to write; without it, the standard output");
  line.add("frame-prefix", options.frame_prefix, "TEXT", "before the names of all links");
  line.addForce(options.overwrite);
  if (!line.parse(argc, argv, std::cout)) {
    return std::nullopt;
  }
  return options;
}

void writeUrdf(const Options& options) {
  const ActuatorDimensions dimensions =
      options.dimensions_path ? loadDimensions(*options.dimensions_path) : ActuatorDimensions{};
  const std::string text =
      renderUrdf(loadActuator(options.actuator_path), dimensions, options.frame_prefix);
  if (!options.output_path) {
    std::cout << text;
    return;
  }
  writeFileAtomically(*options.output_path, text, options.overwrite);
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("generate_urdf", [&] {
    const auto options = sac::parseOptions(argc, argv);
    if (options) {
      sac::writeUrdf(*options);
    }
    return sac::kToolSuccess;
  });
}
