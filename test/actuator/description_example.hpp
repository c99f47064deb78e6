#pragma once

#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"

namespace sac {

/// A description with one line per value, so that each can be spoilt.
inline constexpr const char* kDescription =
    "actuator:\n"                                                             // line 1
    "  name: test\n"                                                          // 2
    "  serial: unit-001\n"                                                    // 3
    "  joints:\n"                                                             // 4
    "    - {name: joint_1, axis: [1, 0, 0], offset: 0.0}\n"                   // 5
    "    - {name: joint_2, axis: [0, 1, 0], offset: 0.1}\n"                   // 6
    "    - {name: joint_3, axis: [0, 0, 1], offset: 0.0}\n"                   // 7
    "  poles:\n"                                                              // 8
    "    - {polar: 0.0, azimuth: 0.0, polarity: 1}\n"                         // 9
    "    - {polar: 0.1, azimuth: 0.8, polarity: -1}\n"                        // 10
    "  coils:\n"                                                              // 11
    "    - {polar: 0.2618, azimuth: 0.0}\n"                                   // 12
    "  torque_curve: {angle_unit: deg, coefficients: [0.0, 0.05], "           // 13
    "blend_start: 2.0, support: [28.0, 32.0]}\n"                              //
    "  workspace: {tilt_limit: 0.6}\n"                                        // 14
    "  calibration:\n"                                                        // 15
    "    date: 2024-05-31T12:00:00Z\n"                                        // 16
    "    revision: 2\n"                                                       // 17
    "    source: [{recording: a.bag, checksum: 'sha256:0'}]\n"                // 18
    "    software: 0.1.0\n"                                                   // 19
    "    cycles:\n"                                                           // 20
    "      - {cycle: joint, coil: 0, samples_used: 5, samples_rejected: 1, "  // 21
    "error_before: 0.05, error_after: 0.001, unit: rad, reduced_chi_square: 1.0}\n"
    "    unidentified: [joint_3/axis_u]\n";  // 22

/// kDescription with one passage replaced.
inline std::string spoilt(const std::string& from, const std::string& to) {
  std::string text = kDescription;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// kDescription with other lines in the place of its joints.
inline std::string withoutJoints(const std::string& instead = "joints: []\n") {
  std::string text = kDescription;
  const std::size_t first = text.find("joints:");
  return text.replace(first, text.find("  poles:") - first, instead);
}

/// What is told about a text that is refused; it stands for f.yaml.
inline std::string messageFor(const std::string& text) {
  return errorMessage<ConfigError>([&] { parseDescription(text, "f.yaml"); });
}

}  // namespace sac
