#include "spherical_actuator_calibration/calibration/calibration_config.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"

namespace sac {
namespace {

constexpr std::int64_t kLargestCount = 1'000'000;
constexpr auto kHarmonics = effect_name::kEncoderHarmonics;  // of all joints, or a list of joints

std::string wordOf(MapUse use) {
  switch (use) {
    case MapUse::kAuto:
      return "auto";
    case MapUse::kAlways:
      return "always";
    case MapUse::kNever:
      break;
  }
  return "never";
}

MapUse mapUseOf(const std::string& word) {
  return word == "auto" ? MapUse::kAuto : word == "always" ? MapUse::kAlways : MapUse::kNever;
}

/// Meets every option of a configuration under its section and key, in the order of the file.
/// `Visitor` has section(name), and option(key, value, …) for each type of value. Reading and
/// writing share it, so that neither can forget an option.
template <typename Config, typename Visitor>
void visitDwell(Config& c, Visitor& visit) {
  const ValueRange seconds = ValueRange::positive("s");
  const ValueRange wait = ValueRange::nonNegative("s");
  const ValueRange angle = ValueRange::positive("rad");
  visit.section("dwell");
  visit.option("rest_window", c.samples.rest_window, seconds);
  visit.option("largest_joint_spread", c.samples.largest_joint_spread, angle);
  visit.option("largest_joint_drift", c.samples.largest_joint_drift, angle);
  visit.option("largest_orientation_motion", c.samples.largest_orientation_motion, angle);
  visit.option("settle_after_motion", c.samples.settle_after_motion, wait);
  visit.option("guard_before_motion", c.samples.guard_before_motion, wait);
  visit.option("largest_dwell", c.samples.largest_dwell, ValueRange::closed(0.0, 3600.0, "s"));

  visit.section("currents");
  visit.option("threshold", c.samples.current_threshold, ValueRange::positive("A"));
  visit.option("tolerance", c.samples.current_tolerance, ValueRange::positive("A"));
  visit.option("settle_after_change", c.samples.settle_after_current_change, wait);
  visit.option("guard_before_change", c.samples.guard_before_current_change, wait);
  visit.option("bias_removal", c.samples.bias_removal);
}

template <typename Config, typename Visitor>
void visitMeans(Config& c, Visitor& visit) {
  const ValueRange seconds = ValueRange::positive("s");
  visit.section("means");
  visit.option("smallest_duration", c.samples.smallest_duration, seconds);
  visit.option("smallest_count", c.samples.smallest_count, 3);
  visit.option("outlier_factor", c.samples.outlier_factor, ValueRange::closed(3.0, 1e6));
  visit.option("joint_stddev_floor", c.samples.joint_stddev_floor, ValueRange::nonNegative("rad"));
  visit.option("orientation_stddev_floor",
               c.samples.orientation_stddev_floor,
               ValueRange::nonNegative("rad"));
  visit.option(
      "torque_stddev_floor", c.samples.torque_stddev_floor, ValueRange::nonNegative("N·m"));

  visit.section("streams");
  visit.option("largest_gap", c.samples.largest_gap, seconds);
  visit.option("timeout", c.samples.stream_timeout, ValueRange::closed(0.01, 60.0, "s"));
  visit.option("clock_reset", c.samples.clock_reset, seconds);
  visit.option("largest_jump", c.samples.largest_jump, seconds);
}

template <typename Config, typename Visitor>
void visitEstimation(Config& c, Visitor& visit) {
  visit.section("estimation");
  visit.option("max_iterations", c.estimation.max_iterations, 1);
  visit.option("unobservable_stddev",
               c.estimation.unobservable_stddev,
               ValueRange{0.0, 1.0, "rad", true, false});
  visit.option(
      "false_alarm_probability", c.estimation.false_alarm_probability, ValueRange::open(0.0, 0.5));
  visit.option("max_rejected_fraction",
               c.estimation.max_rejected_fraction,
               ValueRange{0.0, 0.5, "", false, true});
  visit.option("max_reduced_chi_square",
               c.estimation.max_reduced_chi_square,
               ValueRange{1.0, std::numeric_limits<double>::infinity(), "", true, false});
  visit.option("max_deviation",
               c.estimation.max_deviation,
               ValueRange{0.0, std::numeric_limits<double>::infinity(), "tolerances", true, false});
  visit.option("shared_errors", c.estimation.shared_errors);
  visit.option("min_joint_motion", c.estimation.min_joint_motion, ValueRange::positive("rad"));
  visit.option("default_orientation_stddev",
               c.estimation.default_orientation_stddev,
               ValueRange::positive("rad"));
  visit.option(
      "default_torque_stddev", c.estimation.default_torque_stddev, ValueRange::positive("N·m"));

  const ValueRange tolerance = ValueRange::closed(0.0, 1.0, "rad");
  visit.section("tolerance");
  visit.option("joint_offset", c.tolerance.joint_offset, tolerance);
  visit.option("joint_axis", c.tolerance.joint_axis, tolerance);
  visit.option("pole", c.tolerance.pole, tolerance);
  visit.option("coil", c.tolerance.coil, tolerance);
  visit.option("effect", c.tolerance.effect, ValueRange::closed(0.0, 1.0));
}

template <typename Config, typename Visitor>
void visitOptions(Config& c, Visitor& visit) {
  visit.section("frames");
  visit.option("stator", c.frames.stator);
  visit.option("rotor", c.frames.rotor);
  visitDwell(c, visit);
  visitMeans(c, visit);
  visitEstimation(c, visit);
  visit.section("effects");
  for (const std::string& effect : effectNames()) {
    if (effect == kHarmonics) {
      visit.harmonics(effect, c.effects);
    } else {
      visit.option(effect, c.effects[effect]);
    }
  }
  visit.section("orientation_map");
  visit.option("use", c.orientation_map);
  const ValueRange registration = ValueRange::closed(0.0, 0.5, "rad");
  visit.section("registration");
  visit.option("stator_tracker", c.registration.stator_tracker, registration);
  visit.option("rotor_marker", c.registration.rotor_marker, registration);
  visit.option("rotor_ft_sensor", c.registration.rotor_ft_sensor, registration);
  visit.option("tracker_and_marker", c.registration.tracker_and_marker);
  visit.section("validation");
  visit.option("hold_out_every", c.hold_out_every, 0);
  visit.section("wanted_accuracy");
  visit.option("orientation", c.wanted.orientation, ValueRange::nonNegative("rad"));
  visit.option("torque", c.wanted.torque, ValueRange::nonNegative("N·m/A"));
}

/// Reads the options that a file gives; the others keep their values.
class OptionReader {
 public:
  explicit OptionReader(const YamlMap& file) : file_(file), section_(file) {}

  void section(const std::string& name) {
    has_section_ = file_.has(name);
    if (has_section_) {
      section_ = file_.map(name);
    }
  }
  void option(const std::string& key, double& value, const ValueRange& range) const {
    if (has_section_) {
      value = section_.number(key, range, value);
    }
  }
  void option(const std::string& key,
              std::optional<double>& stddev,
              const ValueRange& range) const {
    if (has_section_ && section_.has(key)) {
      stddev = section_.map(key).number("stddev", range);
    }
  }
  void option(const std::string& key, std::optional<FrameCovariance>& covariance) const {
    if (has_section_ && section_.has(key)) {
      const ValueRange range = ValueRange::closed(-0.25, 0.25, "rad²");
      covariance = frameCovariance(
          section_.map(key).numbers("covariance", range, FrameCovariance::SizeAtCompileTime));
      if (!covariance) {
        section_.fail(key + ".covariance",
                      "it must be symmetric and positive definite, 6 rows of 6 numbers one after "
                      "another; of frames that are exact, state a stddev of 0 each.");
      }
    }
  }
  void option(const std::string& key, int& value, std::int64_t minimum) const {
    if (has_section_) {
      value = static_cast<int>(section_.integer(key, minimum, kLargestCount, value));
    }
  }
  void option(const std::string& key, std::string& value) const {
    if (has_section_ && section_.has(key)) {
      value = section_.nonEmptyText(key);
    }
  }
  void option(const std::string& key, bool& value) const {
    if (has_section_) {
      value = section_.boolean(key, value);
    }
  }
  void option(const std::string& key, BiasRemoval& value) const {
    if (has_section_ && section_.has(key)) {
      const bool none = section_.choice(key, {"none", "zero_current"}) == "none";
      value = none ? BiasRemoval::kNone : BiasRemoval::kZeroCurrent;
    }
  }
  void option(const std::string& key, MapUse& value) const {
    if (has_section_ && section_.has(key)) {
      value = mapUseOf(section_.choice(key, {"auto", "always", "never"}));
    }
  }
  /// true, false, or a list of joints, from 1.
  void harmonics(const std::string& key, EffectSelection& effects) const {
    if (!has_section_ || !section_.hasList(key)) {
      option(key, effects[key]);
      return;
    }
    std::set<std::size_t> joints;
    for (const double number : section_.numbers(key, ValueRange::closed(1.0, kJoints))) {
      const std::optional<std::size_t> joint = indexOf(static_cast<std::uint32_t>(number));
      if (number != std::floor(number) || !joints.insert(*joint).second) {
        section_.fail(key, "it lists joints, each by its number and once.");
      }
    }
    effects[key] = !joints.empty();
    effects.setHarmonicJoints({joints.begin(), joints.end()});
  }

 private:
  YamlMap file_;
  YamlMap section_;
  bool has_section_ = false;
};

/// Writes every option.
class OptionWriter {
 public:
  void section(const std::string& name) {
    section_ = name;
    has_begun_ = false;
  }
  void option(const std::string& key, double value, const ValueRange& /*range*/) {
    add(key, yamlNumber(value));
  }
  /// What is not stated has no key: any value would state something.
  void option(const std::string& key,
              const std::optional<double>& stddev,
              const ValueRange& /*range*/) {
    if (stddev) {
      beginSection();
      writer_.map(1, key);
      writer_.entry(2, "stddev", yamlNumber(*stddev));
    }
  }
  void option(const std::string& key, const std::optional<FrameCovariance>& covariance) {
    if (covariance) {
      beginSection();
      writer_.map(1, key);
      writer_.entry(2, "covariance", yamlNumbers(rowByRow(*covariance)));
    }
  }
  void option(const std::string& key, int value, std::int64_t /*minimum*/) {
    add(key, std::to_string(value));
  }
  void option(const std::string& key, const std::string& value) { add(key, yamlText(value)); }
  void option(const std::string& key, bool value) { add(key, yamlBoolean(value)); }
  void option(const std::string& key, BiasRemoval value) {
    add(key, value == BiasRemoval::kNone ? "none" : "zero_current");
  }
  void option(const std::string& key, MapUse value) { add(key, wordOf(value)); }
  void harmonics(const std::string& key, const EffectSelection& effects) {
    std::vector<std::string> joints;
    for (const std::size_t joint : effects.harmonicJoints()) {
      joints.push_back(std::to_string(numberOf(joint)));
    }
    const bool is_all = joints.size() == kJoints;
    add(key, effects[key] && !is_all ? yamlList(joints) : yamlBoolean(effects[key]));
  }
  std::string text() const { return writer_.text(); }
  /// Name, as section.key, and value of every option.
  const std::vector<std::pair<std::string, std::string>>& options() const { return options_; }

 private:
  void add(const std::string& key, const std::string& value) {
    options_.emplace_back(section_ + "." + key, value);
    beginSection();
    writer_.entry(1, key, value);
  }

  /// Not before it has an entry: an empty section would be no map.
  void beginSection() {
    if (!has_begun_) {
      writer_.map(0, section_);
      has_begun_ = true;
    }
  }

  std::string section_;
  std::vector<std::pair<std::string, std::string>> options_;
  YamlWriter writer_;
  bool has_begun_ = false;  ///< the section, in the text
};

CalibrationConfig readWholeConfig(const YamlMap& file, const std::string& name) {
  CalibrationConfig config = readCalibrationConfig(file, name);
  file.finish();
  return config;
}

}  // namespace

void validate(const CalibrationConfig& config) {
  validate(config.samples);
  validate(config.estimation);
  validate(config.tolerance);
  requireInRange(
      "wanted_accuracy.orientation", config.wanted.orientation, ValueRange::nonNegative("rad"));
  requireInRange("wanted_accuracy.torque", config.wanted.torque, ValueRange::nonNegative("N·m/A"));
  requireInRange("hold_out_every",
                 config.hold_out_every,
                 ValueRange::closed(0.0, static_cast<double>(kLargestCount)));
  if (config.hold_out_every == 1) {
    throw ConfigError("hold_out_every: 1 would hold out every sample; give 2 or more, or 0.");
  }
  validate(config.registration);
  if (config.estimation.current_threshold != config.samples.current_threshold) {
    throw ConfigError("current_threshold: samples and estimation must have the same one.");
  }
}

void stateRegistration(CalibrationConfig& config, const RegistrationUncertainty& registration) {
  config.registration = registration;
  stateRegistration(config.effects, registration);
}

CalibrationConfig readCalibrationConfig(const YamlMap& file, const std::string& name) {
  CalibrationConfig config;
  OptionReader reader(file);
  visitOptions(config, reader);
  config.estimation.current_threshold = config.samples.current_threshold;
  config.estimation.tolerance = config.tolerance;
  stateRegistration(config, config.registration);
  try {
    validate(config);
  } catch (const ConfigError& error) {
    throw ConfigError(name + ": " + error.what());
  }
  return config;
}

CalibrationConfig loadCalibrationConfig(const std::string& path) {
  return readWholeConfig(YamlMap::parse(readInputFile(path, kLargestConfiguration), path), path);
}

CalibrationConfig parseCalibrationConfig(const std::string& text, const std::string& name) {
  return readWholeConfig(YamlMap::parse(text, name), name);
}

std::vector<std::string> changedStreamOptions(const CalibrationConfig& config) {
  OptionWriter present;
  OptionWriter defaults;
  const CalibrationConfig default_config;
  visitDwell(config, present);
  visitMeans(config, present);
  visitDwell(default_config, defaults);
  visitMeans(default_config, defaults);
  std::vector<std::string> changed;
  for (std::size_t n = 0; n < present.options().size(); ++n) {
    // The threshold also tells the estimation which coils were excited.
    const auto& option = present.options()[n];
    if (option != defaults.options()[n] && option.first != "currents.threshold") {
      changed.push_back(option.first);
    }
  }
  return changed;
}

std::string renderCalibrationConfig(const CalibrationConfig& config) {
  OptionWriter writer;
  visitOptions(config, writer);
  return writer.text();
}

}  // namespace sac
