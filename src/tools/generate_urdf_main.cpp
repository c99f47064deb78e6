#include <iostream>
#include <optional>
#include <string>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/urdf_generator.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

struct Options {
  std::string actuator_path;
  std::string dimensions_path;  ///< empty: the paper's
  std::string output_path;      ///< empty: standard output
  std::string frame_prefix;
  bool force = false;
};

std::optional<Options> parseOptions(int argc, char** argv) {
  namespace po = boost::program_options;
  Options options;
  po::options_description known("Options");
  known.add_options()(
      "actuator", po::value(&options.actuator_path)->required(), "actuator description (YAML)")(
      "dimensions",
      po::value(&options.dimensions_path),
      "sizes, materials and limits (YAML); every key in config/actuator_dimensions.yaml")(
      "output",
      po::value(&options.output_path),
      "robot description to write (URDF); without it, the standard output")(
      "frame-prefix", po::value(&options.frame_prefix), "before the names of all links")(
      "force", po::bool_switch(&options.force), "replace the output if it exists");
  if (!parseCommandLine(argc,
                        argv,
                        known,
                        "Usage: generate_urdf --actuator A.yaml [--output U.urdf]\n\n"
                        "Writes the robot description of an actuator, with any number of poles and "
                        "coils.\n")) {
    return std::nullopt;
  }
  return options;
}

void writeUrdf(const Options& options) {
  const ActuatorDimensions dimensions = options.dimensions_path.empty()
                                            ? ActuatorDimensions{}
                                            : loadDimensions(options.dimensions_path);
  const std::string text =
      renderUrdf(loadActuator(options.actuator_path), dimensions, options.frame_prefix);
  if (options.output_path.empty()) {
    std::cout << text;
    return;
  }
  writeFileAtomically(options.output_path,
                      text,
                      options.force ? OverwritePolicy::kReplace : OverwritePolicy::kRefuse);
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
