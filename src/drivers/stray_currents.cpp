#include "spherical_actuator_calibration/drivers/stray_currents.hpp"

#include <algorithm>
#include <cmath>

namespace sac {
namespace {

/// What was set flows no more so long after next to nothing was set [s].
constexpr double kLongestFlow = 0.3;
constexpr double kMostStrays = 0.2;        // [s]
constexpr double kForgivenStrays = 0.005;  // [s] in a second
constexpr double kLongestCounted = 0.05;   // [s] that one measurement stands for
/// By which an amplifier may go beyond what is set, on its way there.
constexpr double kOvershoot = 1.2;

}  // namespace

StrayCurrents::StrayCurrents(std::size_t coils, double tolerance)
    : tolerance_(tolerance), coils_(coils) {}

void StrayCurrents::setting(const Eigen::VectorXd& setpoints) {
  for (std::size_t k = 0; k < coils_.size(); ++k) {
    Coil& coil = coils_[k];
    coil.setpoint = setpoints[static_cast<Eigen::Index>(k)];
    const double set = std::abs(coil.setpoint);
    coil.lately = std::max(coil.lately, set);
    if (set > tolerance_) {
      coil.since.reset();
      coil.highest = 0.0;
    } else {
      coil.highest = std::max(coil.highest, set);
    }
    if (set > 0.0) {
      coil.zero_since.reset();
    }
  }
}

std::optional<std::size_t> StrayCurrents::observe(const Eigen::VectorXd& measured, double steady) {
  began_at_ = last_ ? began_at_ : steady;
  const bool is_beginning = steady - began_at_ <= kLongestFlow;
  const double elapsed = std::min(steady - last_.value_or(steady), kLongestCounted);
  const bool is_span_over = steady - span_since_ > kLongestFlow;
  std::optional<std::size_t> stray;
  for (std::size_t k = 0; k < coils_.size(); ++k) {
    const double current = std::abs(measured[static_cast<Eigen::Index>(k)]);
    const bool is_more = current > allowed(coils_[k], steady);
    if (is_more && !is_beginning) {
      stray = k;
    }
    if (is_span_over) {
      coils_[k].before = coils_[k].lately;
      coils_[k].lately = std::abs(coils_[k].setpoint);
    }
  }
  span_since_ = is_span_over ? steady : span_since_;
  last_ = steady;
  strays_ = std::max(strays_ + (stray ? elapsed : -kForgivenStrays * elapsed), 0.0);
  return strays_ >= kMostStrays ? stray : std::nullopt;
}

/// |current| [A] of a coil that something explains.
double StrayCurrents::allowed(Coil& coil, double steady) const {
  // Both spans reach back to all that can still be on its way.
  const double recent = tolerance_ + kOvershoot * std::max(coil.lately, coil.before);
  if (std::abs(coil.setpoint) > tolerance_) {
    return recent;
  }
  coil.since = coil.since.value_or(steady);
  if (coil.setpoint == 0.0) {
    coil.zero_since = coil.zero_since.value_or(steady);
  }
  if (steady - *coil.since <= kLongestFlow) {
    return recent;
  }
  const bool is_zero = coil.zero_since && steady - *coil.zero_since > kLongestFlow;
  return tolerance_ + (is_zero ? 0.0 : coil.highest);
}

}  // namespace sac
