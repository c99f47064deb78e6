#include "steady_torque.hpp"

#include <algorithm>
#include <vector>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {
namespace {

/// Sums over the windows before each, and over all.
std::vector<TorqueEvidence> sumsBefore(const MotionTerms& terms) {
  std::vector<TorqueEvidence> sums(1);
  for (std::size_t n = 0; n < terms.windowCount(); ++n) {
    sums.push_back(sums.back());
    if (terms.windows()[n].serves()) {
      const TorqueEvidence one = terms.steadyTorque(n);
      sums.back().information += one.information;
      sums.back().gradient += one.gradient;
    }
  }
  return sums;
}

/// By how much a torque in them would explain their misfit: χ² with three degrees of freedom where
/// there is none, and less, as the parameters have taken up a part.
double explained(const TorqueEvidence& before, const TorqueEvidence& until) {
  const Eigen::Matrix3d information = until.information - before.information;
  const Eigen::Vector3d gradient = until.gradient - before.gradient;
  const Cholesky3 factor(information);
  return factor.isPositive() ? gradient.dot(factor.solve(gradient)) : 0.0;
}

/// Mean square of the residuals of what serves, where it is above that of noise.
double misfitOf(const MotionTerms& terms) {
  double squares = 0.0;
  double count = 0.0;
  for (const WindowTerm& term : terms.windows()) {
    squares += term.serves() ? term.square : 0.0;
    count += term.serves() ? 1.0 : 0.0;
  }
  return count > 0.0 ? std::max(1.0, squares / count) : 1.0;
}

}  // namespace

std::optional<WindowRun> steadilyPushed(const MotionTerms& terms) {
  constexpr std::size_t kShortest = 4;  // windows
  constexpr double kFalseAlarm = 1e-3;  // in a recording
  const std::vector<TorqueEvidence> sums = sumsBefore(terms);
  const std::size_t windows = terms.windowCount();
  WindowRun best;
  double most = 0.0;
  double runs = 0.0;
  for (std::size_t length = kShortest; 2 * length <= windows; length += length / 4) {
    for (std::size_t first = 0; first + length <= windows; first += length / 4) {
      runs += 1.0;
      const double square = explained(sums[first], sums[first + length]);
      if (square > most) {
        most = square;
        best = {first, length};
      }
    }
  }
  const bool is_chance =
      runs == 0.0 || most <= misfitOf(terms) * chiSquareLimit(3.0, kFalseAlarm / runs);
  return is_chance ? std::nullopt : std::optional<WindowRun>(best);
}

}  // namespace sac
