#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

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

  /// Joints whose encoders have harmonics, ascending from 0, where encoder_harmonics is modelled.
  const std::vector<std::size_t>& harmonicJoints() const { return harmonic_joints_; }
  void setHarmonicJoints(std::vector<std::size_t> joints) { harmonic_joints_ = std::move(joints); }

  /// Whether each effect is asked for by itself. Else they are modelled together, and where several
  /// tell how strong poles and coils are, some are relative to others.
  bool isOneByOne() const { return is_one_by_one_; }
  void setOneByOne() { is_one_by_one_ = true; }

  const std::map<std::string, bool>& all() const { return modelled_; }
  const std::map<std::string, double>& stddevs() const { return stddevs_; }

 private:
  std::map<std::string, bool> modelled_;
  std::map<std::string, double> stddevs_;
  std::vector<std::size_t> harmonic_joints_ = {0, 1, 2};
  bool is_one_by_one_ = false;
};

}  // namespace sac
