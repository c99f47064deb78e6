#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace sac {

/// What is stated beforehand of several effects at once, whose values err together.
struct StatedTogether {
  std::string name;                  ///< in a budget of uncertainty
  std::vector<std::string> effects;  ///< each with as many values
  Eigen::MatrixXd covariance;        ///< of their values, effect by effect; positive definite
};

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
  /// Instead of what is stated of it together with others, which stays for them.
  void setStddev(const std::string& effect, double stddev);

  /// States several effects with how they err together: of each, the root mean square of its values
  /// counts as its stddev(). An effect is stated so once at most.
  void setTogether(StatedTogether stated);
  const std::vector<StatedTogether>& together() const { return together_; }
  /// Name of what states an effect: of several together, or its own.
  const std::string& statementOf(const std::string& effect) const;

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
  std::vector<StatedTogether> together_;
  std::vector<std::size_t> harmonic_joints_ = {0, 1, 2};
  bool is_one_by_one_ = false;
};

}  // namespace sac
