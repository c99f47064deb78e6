#include "spherical_actuator_calibration/base/noise_source.hpp"

namespace sac {
namespace {

std::mt19937_64 seededGenerator(std::uint64_t seed, RandomPurpose purpose) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed),
                         static_cast<std::uint32_t>(seed >> 32U),
                         static_cast<std::uint32_t>(purpose)};
  return std::mt19937_64(sequence);
}

}  // namespace

NoiseSource::NoiseSource(std::uint64_t seed, RandomPurpose purpose)
    : generator_(seededGenerator(seed, purpose)) {}

std::size_t NoiseSource::index(std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator_);
}

Eigen::Vector3d NoiseSource::gaussianVector(double stddev) {
  Eigen::Vector3d vector;
  for (double& component : vector) {
    component = gaussian(stddev);
  }
  return vector;
}

Eigen::Vector3d NoiseSource::uniformVector(double half_width) {
  Eigen::Vector3d vector;
  for (double& component : vector) {
    component = uniform(half_width);
  }
  return vector;
}

Eigen::Vector3d NoiseSource::direction() {
  return gaussianVector(1.0).normalized();
}

}  // namespace sac
