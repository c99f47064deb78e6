#include "calibrate_bag_options.hpp"

#include <ostream>
#include <regex>

#include <boost/program_options.hpp>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

namespace sac {
namespace {

namespace po = boost::program_options;

constexpr char kIntroduction[] =
    "Usage: calibrate_bag --actuator A.yaml --output OUT.yaml [options] BAG...\n"
    "\n"
    "Calibrates the actuator that the description names from recordings, read directly and "
    "without\n"
    "a master: from the topic samples where it was recorded, else from joint_states,\n"
    "measured_orientation, measured_torque and coil_currents.\n"
    "Exit status: 0 all cycles succeeded; 1 a cycle failed or a parameter is not observable (the\n"
    "others are written); 2 bad usage or unreadable input.\n";

po::typed_value<std::string>* text(const char* name) {
  return po::value<std::string>()->value_name(name);
}

po::options_description visibleOptions() {
  po::options_description known("Options");
  known.add_options()("help,h", "print this help and exit");
  known.add_options()("actuator", text("YAML"), "actuator description; needed");
  known.add_options()("config", text("YAML"), "configuration; config/calibration.yaml shows all");
  known.add_options()("ns", text("NAME"), "namespace of the recorded topics (/actuator)");
  known.add_options()("cycles",
                      text("LIST"),
                      "cycles in this order: joint, poles:J (coil J excited), coil:J, coils (every "
                      "other coil with samples), refine; without it, all that the data allow");
  known.add_options()("output", text("YAML"), "calibrated description to write; needed");
  known.add_options()("urdf", text("URDF"), "calibrated robot description to write");
  known.add_options()("urdf-template",
                      text("URDF"),
                      "robot description to start from; without it the shipped one of that name");
  known.add_options()(
      "report",
      text("DIR"),
      "folder for the report: report.html for people, report.yaml with all figures");
  known.add_options()("truth", text("YAML"), "true parameters, to compare with");
  known.add_options()("date", text("ISO8601"), "date of the calibration, in UTC; without it now");
  known.add_options()("force", "replace files that exist");
  return known;
}

po::variables_map parseCommandLine(int argc, const char* const* argv) {
  po::options_description all = visibleOptions();
  all.add_options()("bag", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("bag", -1);
  po::variables_map given;
  // No guessing: a misspelt option must not become another one.
  const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  po::store(
      po::command_line_parser(argc, argv).options(all).positional(positional).style(style).run(),
      given);
  return given;
}

std::optional<std::string> textOf(const po::variables_map& given, const char* option) {
  if (given.count(option) == 0) {
    return std::nullopt;
  }
  const auto& value = given[option].as<std::string>();
  if (value.empty()) {
    throw ConfigError("--" + std::string(option) + " needs a value.");
  }
  return value;
}

std::string requiredText(const po::variables_map& given, const char* option) {
  if (auto value = textOf(given, option)) {
    return *value;
  }
  throw ConfigError("--" + std::string(option) + " is needed; --help tells what it is.");
}

void requireDate(const std::string& date) {
  static const std::regex form(R"(\d{4}-\d{2}-\d{2}T\d{2}:\d{2}:\d{2}Z)");
  if (!std::regex_match(date, form)) {
    throw ConfigError("--date: \"" + date + "\" is not of the form 2024-05-31T12:00:00Z.");
  }
}

CalibrateBagOptions optionsFrom(const po::variables_map& given) {
  CalibrateBagOptions options;
  options.actuator_path = requiredText(given, "actuator");
  options.output_path = requiredText(given, "output");
  if (given.count("bag") == 0) {
    throw ConfigError("At least one recording (BAG) is needed.");
  }
  options.bags = given["bag"].as<std::vector<std::string>>();
  options.config_path = textOf(given, "config");
  options.ns = textOf(given, "ns").value_or(options.ns);
  if (const auto cycles = textOf(given, "cycles")) {
    options.cycles = parseCycles(*cycles);
  }
  options.truth_path = textOf(given, "truth");
  options.urdf_path = textOf(given, "urdf");
  options.urdf_template_path = textOf(given, "urdf-template");
  if (options.urdf_template_path && !options.urdf_path) {
    throw ConfigError("--urdf-template serves --urdf only: name the file to write by --urdf.");
  }
  options.report_folder = textOf(given, "report");
  options.date = textOf(given, "date");
  if (options.date) {
    requireDate(*options.date);
  }
  if (given.count("force") > 0) {
    options.overwrite = OverwritePolicy::kReplace;
  }
  return options;
}

}  // namespace

std::optional<CalibrateBagOptions> parseCalibrateBagOptions(int argc,
                                                            const char* const* argv,
                                                            std::ostream& out) {
  try {
    const po::variables_map given = parseCommandLine(argc, argv);
    if (given.count("help") > 0) {
      out << kIntroduction << "\n" << visibleOptions();
      return std::nullopt;
    }
    return optionsFrom(given);
  } catch (const po::error& error) {
    throw ConfigError(std::string(error.what()) + "; --help tells the options.");
  }
}

}  // namespace sac
