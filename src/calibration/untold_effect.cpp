#include "untold_effect.hpp"

#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>

namespace sac {
namespace {

/// Of a mistake that laboratories and makers do make without noticing: [rad] of a frame, a share of
/// a strength; 0: none is looked at.
double usualSize(const std::string& effect) {
  constexpr double kFrame = 1e-3;
  constexpr double kStrength = 0.05;
  const std::string gain = "/gain";
  const bool is_gain = effect.size() > gain.size() &&
                       effect.compare(effect.size() - gain.size(), gain.size(), gain) == 0;
  return effect == "torque_registration" ? kFrame : (is_gain ? kStrength : 0.0);
}

}  // namespace

std::optional<UntoldEffect> untoldEffect(const TestedEffect& effect) {
  const double size = usualSize(effect.candidate.name);
  if (size <= 0.0) {
    return std::nullopt;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(effect.information);
  for (Eigen::Index k = 0; k < effect.information.rows(); ++k) {
    // Directions that no number of samples would tell are not a question of how many there are.
    if (spectrum.eigenvalues()[k] <= effect.least) {
      continue;
    }
    const double told = size * std::sqrt(spectrum.eigenvalues()[k]);
    return told < kToldFrom
               ? std::optional(UntoldEffect{size, told, size * spectrum.eigenvectors().col(k)})
               : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace sac
