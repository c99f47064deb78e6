#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include <Eigen/Core>

#include "spherical_actuator_calibration/base/random_purpose.hpp"

namespace sac {

/// Random numbers of one purpose. Seed and purpose decide all of them, so that what one purpose
/// draws never changes another; the size of a noise does not change what is drawn after it.
class NoiseSource {
 public:
  NoiseSource(std::uint64_t seed, RandomPurpose purpose);

  /// Normally distributed around 0.
  double gaussian(double stddev) { return stddev * normal_(generator_); }
  /// Uniform within ± half_width.
  double uniform(double half_width) { return half_width * symmetric_(generator_); }
  /// Uniform in [0, 1).
  double share() { return 0.5 * (1.0 + symmetric_(generator_)); }
  /// Uniform in 0 … count − 1; count > 0.
  std::size_t index(std::size_t count);

  /// The same per component.
  Eigen::Vector3d gaussianVector(double stddev);
  Eigen::Vector3d uniformVector(double half_width);
  /// Uniform on the unit sphere.
  Eigen::Vector3d direction();

 private:
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  std::uniform_real_distribution<double> symmetric_{-1.0, 1.0};
};

}  // namespace sac
