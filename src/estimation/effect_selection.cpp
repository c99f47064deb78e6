#include "spherical_actuator_calibration/estimation/effect_selection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sac {
namespace {

/// Their values are one after another, as many of each.
void leaveOut(StatedTogether& stated, const std::string& effect) {
  const auto found = std::find(stated.effects.begin(), stated.effects.end(), effect);
  if (found == stated.effects.end()) {
    return;
  }
  const auto size = stated.covariance.rows() / static_cast<Eigen::Index>(stated.effects.size());
  const Eigen::Index first = size * (found - stated.effects.begin());
  std::vector<Eigen::Index> others;
  for (Eigen::Index k = 0; k < stated.covariance.rows(); ++k) {
    if (k < first || k >= first + size) {
      others.push_back(k);
    }
  }
  stated.covariance = Eigen::MatrixXd(stated.covariance(others, others));
  stated.effects.erase(found);
}

}  // namespace

const bool& EffectSelection::operator[](const std::string& effect) const {
  static constexpr bool kAbsent = false;
  const auto found = modelled_.find(effect);
  return found == modelled_.end() ? kAbsent : found->second;
}

bool EffectSelection::any() const {
  return std::any_of(
      modelled_.begin(), modelled_.end(), [](const auto& entry) { return entry.second; });
}

double EffectSelection::stddev(const std::string& effect) const {
  const auto found = stddevs_.find(effect);
  return found == stddevs_.end() ? 0.0 : found->second;
}

void EffectSelection::setStddev(const std::string& effect, double stddev) {
  stddevs_[effect] = stddev;
  for (StatedTogether& stated : together_) {
    leaveOut(stated, effect);
  }
}

void EffectSelection::setTogether(StatedTogether stated) {
  const Eigen::Index size =
      stated.covariance.rows() / static_cast<Eigen::Index>(stated.effects.size());
  Eigen::Index first = 0;
  for (const std::string& effect : stated.effects) {
    setStddev(effect, std::sqrt(stated.covariance.diagonal().segment(first, size).mean()));
    first += size;
  }
  together_.push_back(std::move(stated));
}

const std::string& EffectSelection::statementOf(const std::string& effect) const {
  for (const StatedTogether& stated : together_) {
    if (std::count(stated.effects.begin(), stated.effects.end(), effect) > 0) {
      return stated.name;
    }
  }
  return effect;
}

}  // namespace sac
