#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"

#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {

std::vector<CoilPattern> singly(const std::vector<std::size_t>& coils) {
  std::vector<CoilPattern> patterns;
  patterns.reserve(coils.size());
  for (const std::size_t coil : coils) {
    patterns.push_back({{coil, 1}});
  }
  return patterns;
}

std::string patternText(const CoilPattern& pattern) {
  std::string text;
  for (const SignedCoil& coil : pattern) {
    text += text.empty() ? "" : " ";
    text += (coil.sign < 0 ? "-" : "+") + std::to_string(numberOf(coil.coil));
  }
  return text;
}

}  // namespace sac
