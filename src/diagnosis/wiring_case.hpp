#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// What a hypothesis may correct.
struct WiringCase {
  Actuator actuator;
  std::vector<Sample> samples;
};

/// One mistake that a laboratory may have made.
struct Hypothesis {
  std::string cause;  ///< with numbers, counted from 1
  /// Of hypotheses with one family only the best can be named: one contains the other.
  std::string family;
  /// Undoes the mistake. `values`: as many as in `start`.
  std::function<void(WiringCase&, const Eigen::VectorXd& values)> correct;
  /// What is wrong and what to change.
  std::function<std::string(const Eigen::VectorXd& values)> sentence;
  Eigen::VectorXd start = Eigen::VectorXd(0);  ///< of its continuous values, where it has any
  /// Whether values are so far from none that a mistake, not tolerance, is meant.
  std::function<bool(const Eigen::VectorXd& values)> is_material = nullptr;
  /// Its one value is the strength of a pole or coil, told with its uncertainty.
  bool is_strength = false;
  /// Of the same family without a value, where one is near its start: a coil that is dead or the
  /// wrong way round has a strength near 0 or −1.
  std::vector<Hypothesis> simpler = {};
  /// The same correction in the description alone, where that can hold it.
  std::function<void(Actuator&, const Eigen::VectorXd& values)> redescribe = nullptr;
  /// Logarithm of the number of choices that it makes by the samples themselves [nats].
  double cost = 0.0;
  /// Factor on measured torques: 1 but for units.
  std::function<double(const Eigen::VectorXd& values)> torque_factor = nullptr;
};

/// Mistakes made together; none: the wiring as described.
using Candidate = std::vector<Hypothesis>;

/// Families of its parts, in any order.
std::multiset<std::string> family(const Candidate& parts);
/// Causes of its parts, in words.
std::string causes(const Candidate& parts);

/// All continuous values of a candidate at their start, one after the other.
Eigen::VectorXd startOf(const Candidate& candidate);

/// The case without the mistakes of a candidate.
WiringCase corrected(const WiringCase& described,
                     const Candidate& candidate,
                     const Eigen::VectorXd& values);

/// Factor on measured torques of all its parts.
double torqueFactor(const Candidate& candidate, const Eigen::VectorXd& values);

/// Of screened candidates of one family, shifts of an index: so many are worth a fit.
inline constexpr std::size_t kMostShifts = 3;

/// A candidate as promising as its screening tells.
struct ScreenedCandidate {
  Candidate parts;
  double gain = 0.0;  ///< against the wiring as described [nats]
};

/// What single candidates contain: others may have crowded it out.
std::vector<ScreenedCandidate> simplerOnes(const std::vector<ScreenedCandidate>& all);

/// The most promising first, `most` at the most.
void keepBest(std::vector<ScreenedCandidate>& candidates, std::size_t most);

}  // namespace sac
