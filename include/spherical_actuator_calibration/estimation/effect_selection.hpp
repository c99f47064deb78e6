#pragma once

#include <map>
#include <string>

namespace sac {

/// Laboratory effects that a calibration models, by their names; the others are taken to be absent.
class EffectSelection {
 public:
  /// Whether it is switched on, or its size is stated.
  bool has(const std::string& effect) const { return (*this)[effect] || stddev(effect) > 0.0; }
  bool& operator[](const std::string& effect) { return modelled_[effect]; }
  const bool& operator[](const std::string& effect) const;
  /// Whether one is switched on.
  bool any() const;

  /// Standard deviation of each value of an effect, as it is stated beforehand: such an effect is
  /// modelled around zero in all cycles that it acts on, be it switched on or not. 0: none is.
  double stddev(const std::string& effect) const;
  void setStddev(const std::string& effect, double stddev) { stddevs_[effect] = stddev; }

  const std::map<std::string, bool>& all() const { return modelled_; }
  const std::map<std::string, double>& stddevs() const { return stddevs_; }

 private:
  std::map<std::string, bool> modelled_;
  std::map<std::string, double> stddevs_;
};

}  // namespace sac
