#include "sample_place.hpp"

#include <cstddef>

#include "signed_degrees.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"

namespace sac {

std::string anglesOf(const msg::CalibrationSample& sample) {
  std::string text;
  for (const double angle : sample.joint_position) {
    text += (text.empty() ? "" : ", ") + signedDegrees(angle);
  }
  return text;
}

std::string coilsOf(const msg::CalibrationSample& sample, double threshold) {
  constexpr std::size_t kMostNamed = 3;
  std::string names;
  std::size_t excited = 0;
  for (std::size_t coil = 0; coil < sample.current.size(); ++coil) {
    if (isExcited(sample.current[coil], threshold)) {
      names += (names.empty() ? "" : ", ") + std::to_string(numberOf(coil));
      ++excited;
    }
  }
  if (excited > kMostNamed) {
    return std::to_string(excited) + " coils";
  }
  return excited == 0 ? "" : (excited == 1 ? "coil " : "coils ") + names;
}

}  // namespace sac
