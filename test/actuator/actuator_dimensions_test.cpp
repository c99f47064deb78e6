#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"

#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/source_dir.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

constexpr char kShippedFile[] = SOURCE_DIR "/config/actuator_dimensions.yaml";

/// Every value, in the order of the shipped file.
std::vector<double> valuesOf(const ActuatorDimensions& d) {
  return {d.rotor_radius,
          d.hoop_thickness,
          d.hoop_height,
          d.hoop_density,
          d.pole_radius,
          d.pole_height,
          d.magnet_density,
          d.shaft_radius,
          d.shaft_length,
          d.inner_shell_radius,
          d.outer_shell_radius,
          d.coil_radius,
          d.coil_height,
          d.torque_limit,
          d.tilt_rate_limit,
          d.spin_rate_limit};
}

std::string parseError(const std::string& text) {
  return errorMessage<ConfigError>([&] { parseDimensions(text, "d.yaml"); });
}

TEST(ActuatorDimensions, ShippedFileHoldsTheDefaults) {
  EXPECT_EQ(valuesOf(loadDimensions(kShippedFile)), valuesOf(ActuatorDimensions{}));
}

TEST(ActuatorDimensions, EveryKeyOfTheShippedFileIsRead) {
  std::istringstream shipped(contentOf(kShippedFile));
  const std::vector<double> defaults = valuesOf(ActuatorDimensions{});
  std::string changed;
  std::vector<double> expected;
  for (std::string line; std::getline(shipped, line);) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos || line[0] == '#' ||
        line.find_first_of("0123456789") != colon + 2) {
      changed += line + "\n";
      continue;
    }
    ASSERT_LT(expected.size(), defaults.size());
    // All larger by the same share: what fits inside each other still does.
    const std::string value = std::to_string(1.25 * defaults[expected.size()]);
    expected.push_back(std::stod(value));
    changed += line.substr(0, colon + 2) + value + "\n";
  }
  EXPECT_EQ(valuesOf(parseDimensions(changed, "d.yaml")), expected) << changed;
}

TEST(ActuatorDimensions, WhatIsLeftOutKeepsItsDefault) {
  const ActuatorDimensions d =
      parseDimensions("dimensions: {stator: {coil_radius: 0.011}}", "d.yaml");
  EXPECT_EQ(d.coil_radius, 0.011);
  EXPECT_EQ(d.rotor_radius, ActuatorDimensions{}.rotor_radius);
}

TEST(ActuatorDimensions, WrongKeysAndValuesAreNamed) {
  EXPECT_NE(parseError("dimensions: {rotor: {raduis: 0.05}}").find("dimensions.rotor.raduis"),
            std::string::npos);
  EXPECT_NE(parseError("dimensions: {stator: {coil_height: 0}}")
                .find("dimensions.stator.coil_height: 0 is outside (0, inf) m"),
            std::string::npos);
}

TEST(ActuatorDimensions, BodiesThatReachIntoEachOtherAreRefused) {
  EXPECT_NE(parseError("dimensions: {rotor: {radius: 0.02}}").find("rotor.radius"),
            std::string::npos);
  EXPECT_NE(parseError("dimensions: {rotor: {radius: 0.09}}").find("stator.coil_height"),
            std::string::npos);
  EXPECT_NE(
      parseError("dimensions: {stator: {inner_shell_radius: 0.12}}").find("inner_shell_radius"),
      std::string::npos);
}

}  // namespace
}  // namespace sac
