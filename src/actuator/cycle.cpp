#include "spherical_actuator_calibration/actuator/cycle.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace sac {
namespace {

constexpr std::array<std::pair<Cycle, const char*>, 5> kCycles = {{
    {Cycle::kJoint, "joint"},
    {Cycle::kPoles, "poles"},
    {Cycle::kCoil, "coil"},
    {Cycle::kRefine, "refine"},
    {Cycle::kMotion, "motion"},
}};

}  // namespace

std::string cycleName(Cycle cycle) {
  const auto* const found = std::find_if(
      kCycles.begin(), kCycles.end(), [&](const auto& entry) { return entry.first == cycle; });
  return found->second;
}

std::vector<std::string> cycleNames() {
  std::vector<std::string> names;
  std::transform(kCycles.begin(), kCycles.end(), std::back_inserter(names), [](const auto& entry) {
    return entry.second;
  });
  return names;
}

std::optional<Cycle> cycleNamed(const std::string& name) {
  for (const auto& [cycle, its_name] : kCycles) {
    if (name == its_name) {
      return cycle;
    }
  }
  return std::nullopt;
}

}  // namespace sac
