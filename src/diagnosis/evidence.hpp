#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Of fewer measurements no mistake is named.
constexpr std::size_t kFewestOrientations = 4;
constexpr std::size_t kFewestTorques = 4;

/// Measurements that may tell of mistakes of wiring.
struct Evidence {
  std::size_t orientations = 0;
  std::size_t torques = 0;
};

/// `nominal`: as described.
Evidence evidenceOf(const Actuator& nominal, const std::vector<Sample>& samples);

/// Why so few samples tell of no mistake, in a sentence; empty where they are enough.
std::string whyNothingIsTold(const Actuator& nominal, const std::vector<Sample>& samples);

}  // namespace sac
