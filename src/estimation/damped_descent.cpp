#include "spherical_actuator_calibration/estimation/damped_descent.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/estimation/information_factor.hpp"

namespace sac {
namespace {

constexpr double kLargestDamping = 1e16;
/// Of a coordinate that nothing tells at some point, as of a pole that left the reach of all coils:
/// without it there would be no step at all.
constexpr double kLeastDiagonal = 1e-6;
/// A step must bring at least this share of the decrease that the linear model promises.
constexpr double kLeastGain = 1e-3;
/// A smaller relative decrease of the cost cannot be told from its rounding.
constexpr double kCostRounding = 1e-13;
/// Of a smooth cost, steps of less than so many times nothing are made of rounding once they no
/// longer shrink.
constexpr double kFineStep = 1e3;

}  // namespace

bool NormalEquations::isFinite() const {
  return std::isfinite(cost) && information.allFinite();
}

std::optional<Eigen::VectorXd> dampedStep(const NormalEquations& here, double damping) {
  const InformationFactor factor(here.information,
                                 damping * here.information.diagonal().cwiseMax(kLeastDiagonal));
  if (!factor.isPositive()) {
    return std::nullopt;
  }
  Eigen::VectorXd step = -factor.solve(here.gradient);
  return step.allFinite() ? std::optional<Eigen::VectorXd>(std::move(step)) : std::nullopt;
}

DampedSteps::DampedSteps(const DescentOptions& options)
    : options_(options), damping_(options.first_damping) {}

void DampedSteps::startAt(NormalEquations here, double nothing) {
  here_ = std::move(here);
  nothing_ = nothing;
  trials_ = 0;
  is_last_ = false;
}

std::optional<Eigen::VectorXd> DampedSteps::next() {
  if (trials_ > 0) {
    if (step_.norm() <= nothing_) {
      is_last_ = true;
      return std::nullopt;
    }
    raiseDamping();
  }
  is_last_ = false;
  for (; damping_ <= kLargestDamping; raiseDamping()) {
    std::optional<Eigen::VectorXd> step = dampedStep(here_, damping_);
    if (!step) {
      continue;
    }
    step_ = *step;
    is_fine_ = isFine();
    is_last_ = endsHere();
    ++trials_;
    return step;
  }
  return std::nullopt;
}

/// By the decrease of the cost over the one that the linear model promises; of a step so short that
/// rounding would judge, none is asked.
bool DampedSteps::takes(double cost) {
  if (isShort()) {
    const bool rises = !(cost <= (1.0 + kCostRounding) * here_.cost);
    if (!rises) {
      take(1.0);
    }
    return !rises;
  }
  const double promised = -step_.dot(2.0 * here_.gradient + here_.information * step_);
  const double gain = promised > 0.0 ? (here_.cost - cost) / promised : 0.0;
  if (!(gain > kLeastGain)) {
    return false;
  }
  take(gain);
  return true;
}

/// Nielsen's rule, as Madsen, Nielsen and Tingleff give it: the better the linear model, the less
/// damping.
void DampedSteps::take(double gain) {
  const double factor = std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * gain - 1.0, 3));
  damping_ = std::max(factor * damping_, kLeastDamping);
  growth_ = 2.0;
  previous_length_ = step_.norm();
}

void DampedSteps::raiseDamping() {
  damping_ *= growth_;
  growth_ *= 2.0;
}

/// Whether the step is too small for the cost to judge it: rounding would.
bool DampedSteps::isFine() const {
  return -step_.dot(here_.gradient) <= kCostRounding * here_.cost ||
         step_.norm() <= (options_.is_smooth ? kFineStep : 1.0) * nothing_;
}

/// The next steps will shrink at least as this one did against the one before, if it is not damping
/// that made it short; where they no longer shrink, they are rounding.
bool DampedSteps::endsHere() const {
  const double length = step_.norm();
  if (length <= nothing_ || trials_ > 0) {
    return length <= nothing_;
  }
  const bool is_first = previous_length_ == 0.0;
  const double shrinkage = is_first ? 1.0 : length / previous_length_;
  if (shrinkage > 0.5) {
    return is_fine_ && !is_first;
  }
  return length * shrinkage / (1.0 - shrinkage) <= nothing_;
}

}  // namespace sac
