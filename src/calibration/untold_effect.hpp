#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "effect_candidates.hpp"

namespace sac {

/// An effect beside the least that a score test tells of it.
struct TestedEffect {
  const EffectCandidate& candidate;
  Eigen::MatrixXd information;  ///< of its columns, once the coordinates made up for what they can
  double least;                 ///< information below it is rounding
  std::size_t poses;            ///< at which torques were measured
};

/// What of an effect a session would not have told: nothing says that it is not there.
struct UntoldEffect {
  double size;            ///< usual one of such a mistake, in the effect's unit
  double told;            ///< standard deviations of its score test at that size
  Eigen::VectorXd value;  ///< of that size, where it is told least
};

/// Standard deviations from which on a single effect is told: as many as score tests ask for.
inline constexpr double kToldFrom = 5.0;

/// Of a force/torque sensor that is turned, or a pole or coil that is stronger or weaker than
/// drawn, by what is usual, where that is told by less than kToldFrom. Others are either relative
/// to what is stated, so that no number of samples tells them, or rare. Values: per column of the
/// effect.
std::optional<UntoldEffect> untoldEffect(const TestedEffect& effect);

}  // namespace sac
