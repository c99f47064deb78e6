#include "calibrate_bag_options.hpp"

#include <filesystem>
#include <regex>

#include "command_line.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

namespace sac {
namespace {

constexpr char kIntroduction[] =
    "Usage: calibrate_bag [--output OUT.yaml] [options] BAG...\n"
    "\n"
    "Calibrates an actuator from recordings, read directly and without a master: from the topic\n"
    "samples where it was recorded, else (or with --from streams) from joint_states,\n"
    "measured_orientation, measured_torque and coil_currents. What the calibration node was "
    "started\n"
    "with is in its recordings; other ones need --actuator.\n"
    "Mistakes of wiring that the samples speak for are told, and no cycle runs before they are "
    "mended.\n"
    "Exit status: 0 all cycles succeeded; 1 a cycle failed or a parameter is not observable (the\n"
    "others are written); 2 bad usage or unreadable input.\n\n";

void requireDate(const std::string& date) {
  static const std::regex form(R"(\d{4}-\d{2}-\d{2}T\d{2}:\d{2}:\d{2}Z)");
  if (!std::regex_match(date, form)) {
    throw ConfigError("--date: \"" + date + "\" is not of the form 2024-05-31T12:00:00Z.");
  }
}

SampleSource parseSource(const std::string& text) {
  if (text == "samples") {
    return SampleSource::kSamples;
  }
  if (text == "streams") {
    return SampleSource::kStreams;
  }
  if (text == "dwells") {
    return SampleSource::kDwells;
  }
  throw ConfigError("--from: \"" + text + "\" is none of: samples, streams, dwells.");
}

/// What cannot be told from one option alone.
void check(const CalibrateBagOptions& options) {
  if (options.bags.empty()) {
    throw ConfigError("At least one recording (BAG) is needed.");
  }
  if (options.check && !options.output_path.empty()) {
    throw ConfigError("--check judges a description and writes none: leave --output out.");
  }
  if (options.output_path.empty() && (options.urdf_path || options.report_folder)) {
    throw ConfigError("--urdf and --report need --output: without it nothing is written.");
  }
  if (options.no_page && !options.report_folder) {
    throw ConfigError("--no-page is of a --report, and there is none.");
  }
  if (options.output_path.empty() && (options.covariance_path || options.certificate_path)) {
    throw ConfigError(
        "--covariance and --certificate need --output: without it nothing is written.");
  }
  if (options.issuer_path && !options.certificate_path) {
    throw ConfigError("--issuer serves --certificate only: name the file to write by it.");
  }
  if (options.urdf_template_path && !options.urdf_path) {
    throw ConfigError("--urdf-template serves --urdf only: name the file to write by --urdf.");
  }
  if (options.date) {
    requireDate(*options.date);
  }
}

/// What is understood only after all has been read.
struct Words {
  std::optional<std::string> cycles;
  std::optional<std::string> source;
  std::optional<std::string> output;
};

void addInputs(CommandLine& line, CalibrateBagOptions& options, Words& words) {
  line.addInput("actuator",
                options.actuator_path,
                "YAML",
                "actuator description; without it the one of the recorded session");
  line.addInput(
      "config",
      options.config_path,
      "YAML",
      "configuration, config/calibration.yaml shows all; without it the one of the recorded "
      "session, or the defaults");
  line.add("ns", options.ns, "NAME", "namespace of the recorded topics");
  line.add("from",
           words.source,
           "samples|streams|dwells",
           "what to calibrate from; without it samples where they were recorded. streams: the "
           "stretches of the streams that these were averaged over, which gives the same result; "
           "dwells: every rest of the rotor. The sections dwell, currents, means and streams of "
           "the configuration act on streams and dwells only");
  line.add(
      "cycles",
      words.cycles,
      "LIST",
      "cycles in this order: joint, poles:J (coil J excited), coil:J, coils (every other coil "
      "with samples), refine, motion (of a rotor that moves: needs no torque); without it, all "
      "that the data allow");
}

void addOutputs(CommandLine& line, CalibrateBagOptions& options, Words& words) {
  line.addOutput("output",
                 words.output,
                 "YAML",
                 "calibrated description to write; without it the result is told only");
  line.addSwitch("diagnose",
                 options.diagnose,
                 "tell mistakes of wiring and effects that the samples speak for: exit status 1 "
                 "where there are any");
  line.addOutput("apply-diagnosis",
                 options.corrected_path,
                 "YAML",
                 "description or configuration to write, corrected by what is diagnosed");
  line.addSwitch("check",
                 options.check,
                 "judge the description by the samples of the recordings: is it still valid?");
  line.addOutput("urdf", options.urdf_path, "URDF", "calibrated robot description to write");
  line.addInput("urdf-template",
                options.urdf_template_path,
                "URDF",
                "robot description to start from; without it the shipped one of that name");
  line.add("report",
           options.report_folder,
           "DIR",
           "folder for the report: report.html for people, report.yaml with all figures");
  line.addSwitch("no-page", options.no_page, "with --report: report.yaml alone, in less time");
  line.addOutput("covariance",
                 options.covariance_path,
                 "YAML",
                 "covariance of all parameters to write, with names, units and uncertainty budget");
  line.addOutput("certificate",
                 options.certificate_path,
                 "XML",
                 "digital calibration certificate to write (PTB's DCC 3.3, with the covariance)");
  line.addInput("issuer",
                options.issuer_path,
                "YAML",
                "laboratory, person and customer that the certificate names");
  line.addInput("truth", options.truth_path, "YAML", "true parameters, to compare with");
  line.add("date", options.date, "ISO8601", "date of the calibration, in UTC; without it now");
}

}  // namespace

std::optional<CalibrateBagOptions> parseCalibrateBagOptions(int argc,
                                                            const char* const* argv,
                                                            std::ostream& out) {
  CalibrateBagOptions options;
  Words words;
  CommandLine line(kIntroduction);
  addInputs(line, options, words);
  addOutputs(line, options, words);
  line.addForce(options.overwrite);
  line.addInputs(options.bags, "BAG");
  if (!line.parse(argc, argv, out)) {
    return std::nullopt;
  }
  options.output_path = words.output.value_or("");
  check(options);
  if (options.report_folder) {
    for (const char* file : {"report.yaml", "report.html"}) {
      line.requireSeparate("report",
                           (std::filesystem::path(*options.report_folder) / file).string());
    }
  }
  if (words.source) {
    options.source = parseSource(*words.source);
  }
  if (words.cycles) {
    options.cycles = parseCycles(*words.cycles);
  }
  return options;
}

}  // namespace sac
