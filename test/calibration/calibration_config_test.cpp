#include "spherical_actuator_calibration/calibration/calibration_config.hpp"

#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

constexpr char kShippedFile[] = SOURCE_DIR "/config/calibration.yaml";

std::string parseError(const std::string& text) {
  return errorMessage<ConfigError>([&] { parseCalibrationConfig(text, "c.yaml"); });
}

TEST(CalibrationConfig, ShippedFileHoldsTheDefaults) {
  EXPECT_EQ(renderCalibrationConfig(loadCalibrationConfig(kShippedFile)),
            renderCalibrationConfig(CalibrationConfig{}));
}

TEST(CalibrationConfig, ShippedFileNamesEveryKeyInItsSection) {
  const std::string shipped = contentOf(kShippedFile);
  std::istringstream options(renderCalibrationConfig(CalibrationConfig{}));
  std::size_t place = 0;
  for (std::string line; std::getline(options, line);) {
    const std::string key = "\n" + line.substr(0, line.find(':') + 1);
    place = shipped.find(key, place);
    ASSERT_NE(place, std::string::npos) << key;
  }
}

/// All values changed, so that an option that one side forgets comes back as its default.
CalibrationConfig changedConfig() {
  CalibrationConfig config;
  config.frames = {"base", "ball"};
  SampleBuilderOptions& samples = config.samples;
  for (double* value : {&samples.rest_window,
                        &samples.largest_joint_spread,
                        &samples.largest_joint_drift,
                        &samples.largest_orientation_motion,
                        &samples.settle_after_motion,
                        &samples.guard_before_motion,
                        &samples.largest_dwell,
                        &samples.current_threshold,
                        &samples.current_tolerance,
                        &samples.settle_after_current_change,
                        &samples.guard_before_current_change,
                        &samples.smallest_duration,
                        &samples.outlier_factor,
                        &samples.joint_stddev_floor,
                        &samples.orientation_stddev_floor,
                        &samples.torque_stddev_floor,
                        &samples.largest_gap,
                        &samples.stream_timeout,
                        &samples.clock_reset,
                        &samples.largest_jump}) {
    *value *= 1.25;
  }
  samples.smallest_count = 17;
  samples.bias_removal = BiasRemoval::kNone;
  EstimationOptions& estimation = config.estimation;
  for (double* value : {&estimation.unobservable_stddev,
                        &estimation.false_alarm_probability,
                        &estimation.max_rejected_fraction,
                        &estimation.max_reduced_chi_square,
                        &estimation.max_deviation,
                        &estimation.current_threshold,
                        &estimation.min_joint_motion,
                        &estimation.default_orientation_stddev,
                        &estimation.default_torque_stddev}) {
    *value *= 1.25;
  }
  estimation.max_iterations = 7;
  estimation.shared_errors = false;
  config.tolerance = {0.01, 0.02, 0.04, 0.05, 0.06};
  for (const std::string& effect : effectNames()) {
    config.effects[effect] = true;
  }
  config.orientation_map = MapUse::kNever;
  config.hold_out_every = 5;
  config.wanted = {1e-3, 2e-3};
  return config;
}

TEST(CalibrationConfig, EveryOptionIsReadAndWritten) {
  const CalibrationConfig config = changedConfig();
  const std::string text = renderCalibrationConfig(config);
  const CalibrationConfig back = parseCalibrationConfig(text, "c.yaml");
  EXPECT_EQ(renderCalibrationConfig(back), text);
  EXPECT_EQ(back.estimation.current_threshold, config.samples.current_threshold);
  std::istringstream changed(text);
  std::istringstream defaults(renderCalibrationConfig(CalibrationConfig{}));
  for (std::string line, other; std::getline(changed, line) && std::getline(defaults, other);) {
    const bool is_section = line.front() != ' ';
    EXPECT_EQ(line == other, is_section) << line;
  }
}

TEST(CalibrationConfig, ChoosesTheJointsWhoseEncodersHaveHarmonics) {
  const auto harmonics = [](const std::string& value) {
    return parseCalibrationConfig("effects: {encoder_harmonics: " + value + "}", "c.yaml").effects;
  };
  using Joints = std::vector<std::size_t>;
  EXPECT_EQ(harmonics("true").harmonicJoints(), (Joints{0, 1, 2}));
  EXPECT_FALSE(harmonics("false")["encoder_harmonics"]);
  EXPECT_FALSE(harmonics("[]")["encoder_harmonics"]);
  const CalibrationConfig config =
      parseCalibrationConfig("effects: {encoder_harmonics: [3, 1]}", "c.yaml");
  EXPECT_TRUE(config.effects["encoder_harmonics"]);
  EXPECT_EQ(config.effects.harmonicJoints(), (Joints{0, 2}));
  EXPECT_EQ(describe(config.effects), "encoder_harmonics joint_1 joint_3");
  const CalibrationConfig back = parseCalibrationConfig(renderCalibrationConfig(config), "r.yaml");
  EXPECT_EQ(back.effects.harmonicJoints(), (Joints{0, 2}));
  for (const char* wrong : {"[0]", "[4]", "[1, 1]", "[1.5]", "[joint_1]"}) {
    EXPECT_THROW(harmonics(wrong), ConfigError) << wrong;
  }
}

TEST(CalibrationConfig, UsesOrientationMapsAsToldAndOfItselfWhereTheyPredict) {
  const auto use = [](const std::string& text) {
    return parseCalibrationConfig(text, "c.yaml").orientation_map;
  };
  EXPECT_EQ(CalibrationConfig{}.orientation_map, MapUse::kAuto);
  EXPECT_EQ(use("orientation_map: {use: always}"), MapUse::kAlways);
  EXPECT_EQ(use("orientation_map: {use: never}"), MapUse::kNever);
  EXPECT_THROW(use("orientation_map: {use: perhaps}"), ConfigError);
}

TEST(CalibrationConfig, WhatIsNotStatedOfRegistrationsStaysUnstated) {
  const CalibrationConfig config =
      parseCalibrationConfig("registration: {rotor_marker: {stddev: 0.001}}", "c.yaml");
  EXPECT_FALSE(config.registration.stator_tracker);
  EXPECT_EQ(config.registration.rotor_marker, 0.001);
  EXPECT_EQ(config.effects.stddev("marker_registration"), 0.001);
  EXPECT_EQ(config.effects.stddev("tracker_registration"), 0.0);
  const CalibrationConfig back =
      parseCalibrationConfig(renderCalibrationConfig(config), "rendered.yaml");
  EXPECT_FALSE(back.registration.stator_tracker);
  EXPECT_EQ(back.registration.rotor_marker, 0.001);
  EXPECT_NE(parseError("registration: {rotor_marker: {stddev: -1.0}}")
                .find("registration.rotor_marker.stddev"),
            std::string::npos);
  EXPECT_NE(parseError("registration: {marker: {stddev: 1.0}}").find("registration.marker"),
            std::string::npos);
}

/// registration/tracker_and_marker of a diagonal, with this covariance of the tracker's x and the
/// marker's z in both places, or in the first alone.
std::string framesText(double covariance, bool is_symmetric = true) {
  std::string numbers;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      const bool is_pair = (row == 0 && column == 5) || (is_symmetric && row == 5 && column == 0);
      numbers += numbers.empty() ? "" : ", ";
      numbers += row == column ? "1e-4" : is_pair ? std::to_string(covariance) : "0";
    }
  }
  return "registration: {tracker_and_marker: {covariance: [" + numbers + "]}";
}

TEST(CalibrationConfig, StatesTrackerAndMarkerTogether) {
  const CalibrationConfig config = parseCalibrationConfig(framesText(5e-5) + "}", "c.yaml");
  ASSERT_TRUE(config.registration.tracker_and_marker);
  EXPECT_EQ((*config.registration.tracker_and_marker)(0, 5), 5e-5);
  EXPECT_DOUBLE_EQ(config.effects.stddev("marker_registration"), 0.01);
  EXPECT_DOUBLE_EQ(config.effects.stddev("tracker_registration"), 0.01);
  const CalibrationConfig back =
      parseCalibrationConfig(renderCalibrationConfig(config), "rendered.yaml");
  ASSERT_TRUE(back.registration.tracker_and_marker);
  EXPECT_EQ(*back.registration.tracker_and_marker, *config.registration.tracker_and_marker);

  const auto is_refused = [](const std::string& text, const char* words) {
    EXPECT_NE(parseError(text).find(words), std::string::npos) << parseError(text);
  };
  is_refused(framesText(5e-5, false) + "}", "symmetric and positive definite");
  is_refused(framesText(2e-4) + "}", "symmetric and positive definite");
  is_refused(framesText(5e-5) + ", rotor_marker: {stddev: 0.01}}", "not both");
  is_refused("registration: {tracker_and_marker: {covariance: [1e-4]}}",
             "registration.tracker_and_marker.covariance");
}

TEST(CalibrationConfig, AbsentKeysHaveTheirDefaults) {
  const CalibrationConfig config = parseCalibrationConfig("tolerance: {pole: 0.25}", "c.yaml");
  EXPECT_EQ(config.tolerance.pole, 0.25);
  EXPECT_EQ(config.tolerance.coil, ManufacturingTolerance{}.coil);
  EXPECT_EQ(config.samples.rest_window, SampleBuilderOptions{}.rest_window);
}

TEST(CalibrationConfig, ErrorsNameFileLineAndKey) {
  EXPECT_NE(parseError("frames: {stator: base}\nspeed: 3\n").find("c.yaml:2: speed"),
            std::string::npos);
  EXPECT_NE(parseError("dwell:\n  rest_windw: 0.3\n").find("c.yaml:2: dwell.rest_windw"),
            std::string::npos);
  EXPECT_NE(parseError("dwell:\n  rest_window: -0.3\n").find("c.yaml:2: dwell.rest_window: -0.3"),
            std::string::npos);
  EXPECT_NE(parseError("means: {smallest_count: 2}").find("c.yaml:1: means.smallest_count"),
            std::string::npos);
  EXPECT_NE(parseError("currents: {bias_removal: maybe}").find("currents.bias_removal"),
            std::string::npos);
  EXPECT_NE(parseError("frames: {rotor: \"\"}").find("frames.rotor"), std::string::npos);
  EXPECT_NE(parseError("estimation: {max_iterations: .nan}").find("estimation.max_iterations"),
            std::string::npos);
}

TEST(CalibrationConfig, RefusesOptionsThatContradictEachOther) {
  const std::string message = parseError("dwell: {largest_dwell: 0.5}");
  EXPECT_EQ(message.find("c.yaml: largest_dwell: 0.5"), 0U) << message;
}

TEST(CalibrationConfig, RefusesToHoldOutEverySample) {
  EXPECT_NE(parseError("validation: {hold_out_every: 1}").find("hold_out_every"),
            std::string::npos);
  EXPECT_EQ(parseError("validation: {hold_out_every: 2}"), "no exception");
}

}  // namespace
}  // namespace sac
