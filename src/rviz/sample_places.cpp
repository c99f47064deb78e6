#include "sample_places.hpp"

#include "signed_degrees.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"

namespace sac {
namespace {

/// More coils than these are counted only.
constexpr std::size_t kMostNamed = 3;

}  // namespace

void SamplePlaces::receive(const msg::CalibrationSample& sample) {
  places_[sample.id] = {{sample.joint_position.begin(), sample.joint_position.end()},
                        {sample.current.begin(), sample.current.end()}};
  if (places_.size() > kMost) {
    places_.erase(places_.begin());
  }
}

std::string SamplePlaces::angles(std::uint32_t id) const {
  const auto place = places_.find(id);
  std::string text;
  if (place == places_.end()) {
    return text;
  }
  for (const double angle : place->second.angles) {
    text += (text.empty() ? "" : ", ") + signedDegrees(angle);
  }
  return text;
}

std::string SamplePlaces::coils(std::uint32_t id, double threshold) const {
  const auto place = places_.find(id);
  if (place == places_.end()) {
    return "";
  }
  const std::vector<double>& currents = place->second.currents;
  std::string names;
  std::size_t excited = 0;
  for (std::size_t coil = 0; coil < currents.size(); ++coil) {
    if (isExcited(currents[coil], threshold)) {
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
