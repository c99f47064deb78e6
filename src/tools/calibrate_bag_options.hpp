#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_reader.hpp"

namespace sac {

/// What the command line of calibrate_bag asks for.
struct CalibrateBagOptions {
  std::optional<std::string> actuator_path;  ///< nothing: as recorded
  std::optional<std::string> config_path;    ///< nothing: as recorded, or the defaults
  std::string ns = "/actuator";
  std::vector<std::string> bags;
  SampleSource source = SampleSource::kSamplesWhereRecorded;
  /// In the order wanted, kCoil with coil 0 for all others; nothing: all that the data allow.
  std::optional<std::vector<CycleRequest>> cycles;
  std::optional<std::string> truth_path;
  std::string output_path;  ///< empty: the result is told, and not written
  bool diagnose = false;    ///< tell what the samples speak for, also where nothing fails
  bool check = false;       ///< judge the description by the samples, instead of calibrating it
  std::optional<std::string> corrected_path;  ///< of what corrects a diagnosed mistake
  std::optional<std::string> urdf_path;
  std::optional<std::string> urdf_template_path;
  std::optional<std::string> covariance_path;
  std::optional<std::string> certificate_path;
  std::optional<std::string> issuer_path;  ///< who issues the certificate
  std::optional<std::string> report_folder;
  bool no_page = false;             ///< the figures of the report alone
  std::optional<std::string> date;  ///< of the calibration; nothing: now
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
};

/// Reads the command line. Without a value: help was asked for and has been printed to `out`.
/// Throws ConfigError, naming the option, when it cannot be understood.
std::optional<CalibrateBagOptions> parseCalibrateBagOptions(int argc,
                                                            const char* const* argv,
                                                            std::ostream& out);

}  // namespace sac
