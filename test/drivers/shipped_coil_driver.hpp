#pragma once

#include <cstddef>

#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"
#include "support/source_dir.hpp"

namespace sac {

/// The coil driver by its shipped configuration.
inline constexpr char kShippedFile[] = SOURCE_DIR "/config/coil_driver.yaml";
inline constexpr std::size_t kCoils = 24;
inline constexpr int kUnit = 2;
inline constexpr double kBeat = 0.005;      // [s]
inline constexpr double kTolerance = 0.15;  // of measured currents [A]
inline constexpr int kBeats = 40;           // that must deviate

inline CurrentAmplifierOptions shippedOptions() {
  return readCurrentAmplifierOptions(YamlMap::load(kShippedFile));
}

}  // namespace sac
