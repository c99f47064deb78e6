#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/CalibrationSample.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// Where samples were taken, by their numbers: at which angles, and with which coils. Of more than
/// kMost the oldest are forgotten.
class SamplePlaces {
 public:
  static constexpr std::size_t kMost = 20000;

  void receive(const msg::CalibrationSample& sample);
  bool knows(std::uint32_t id) const { return places_.count(id) != 0; }

  /// Measured angles in degrees, "+12.0°, −8.1°, +20.3°"; empty of a sample that is not known.
  std::string angles(std::uint32_t id) const;
  /// "coil 3", "coils 3, 7" or "8 coils": those that `threshold` [A] counts as excited; empty of a
  /// sample that is not known, or of no coil.
  std::string coils(std::uint32_t id, double threshold) const;

 private:
  struct Place {
    std::vector<double> angles;    ///< [rad]
    std::vector<double> currents;  ///< [A]
  };

  std::map<std::uint32_t, Place> places_;
};

}  // namespace sac
