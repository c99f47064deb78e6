#include "untold_effect.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"

namespace sac {
namespace {

/// Of a mistake that laboratories and makers do make without noticing: [rad] of a frame, a share of
/// a strength; 0: none is looked at.
double usualSize(const std::string& effect, std::size_t poses) {
  constexpr std::size_t kManyPoses = 20;
  constexpr double kFrame = 1e-3;
  constexpr double kStrength = 0.05;
  const std::string gain = "/gain";
  const bool is_gain = effect.size() > gain.size() &&
                       effect.compare(effect.size() - gain.size(), gain.size(), gain) == 0;
  const bool is_frame = effect == effect_name::kTorqueRegistration && poses < kManyPoses;
  return is_frame ? kFrame : (is_gain ? kStrength : 0.0);
}

}  // namespace

std::optional<UntoldEffect> untoldEffect(const TestedEffect& effect) {
  const double size = usualSize(effect.candidate.name, effect.poses);
  constexpr double kLeastTold = 0.5;  // what takes a hundred times as many samples, none tell
  if (size <= 0.0) {
    return std::nullopt;
  }
  const SymmetricEigen spectrum = symmetricEigen(effect.information);
  for (Eigen::Index k = 0; k < effect.information.rows(); ++k) {
    // Directions that no number of samples would tell are not a question of how many there are.
    const double told = size * std::sqrt(std::max(0.0, spectrum.values[k]));
    if (spectrum.values[k] <= effect.least || told < kLeastTold) {
      continue;
    }
    return told < kToldFrom
               ? std::optional(UntoldEffect{size, told, size * spectrum.vectors.col(k)})
               : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace sac
