#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// An observation whose measured vector is that of an earlier one: nothing was measured twice, for
/// noise never repeats.
struct RepeatedObservation {
  std::size_t place = 0;  ///< among the observations
  std::size_t first = 0;  ///< the earliest one that it repeats
};

/// All of them, ascending. Vectors count as equal within a thousandth of their noise, which is
/// finer than chance comes and coarser than what a file rounds. Torques that hardly stand out of
/// their noise are never told: a coarse sensor honestly repeats them.
std::vector<RepeatedObservation> repeatedObservations(const std::vector<Sample>& samples,
                                                      const std::vector<Observation>& observations,
                                                      const EstimationOptions& options);

/// The same for observations that come one after the other.
class RepeatSearch {
 public:
  explicit RepeatSearch(const EstimationOptions& options) : options_(options) {}

  /// Takes the last of `observations`, all others being taken before it; returns the place of one
  /// that it repeats, which repeats none.
  std::optional<std::size_t> add(const std::vector<Sample>& samples,
                                 const std::vector<Observation>& observations);

 private:
  EstimationOptions options_;
  // Places by a number that is nearly equal where vectors are.
  std::multimap<double, std::uint32_t> orientations_;
  std::multimap<double, std::uint32_t> torques_;
};

/// The observations without those that repeat others.
std::vector<Observation> withoutRepeated(const std::vector<Observation>& observations,
                                         const std::vector<RepeatedObservation>& repeated);

/// Standardized residuals below this have no noise, as in a simulation, which honestly repeats.
inline constexpr double kNoNoise = 1e-3;

/// Whether the residuals of the streams that repeat have no noise, as in a simulation: there equal
/// measurements are honest.
bool areWithoutNoise(const std::vector<Observation>& observations,
                     const std::vector<RepeatedObservation>& repeated,
                     const Estimate& estimate);

/// "12 of 160 torques repeat …" in a sentence or two that an operator can act on; empty where
/// nothing repeats.
std::string repeatedInWords(const std::vector<Sample>& samples,
                            const std::vector<Observation>& observations,
                            const std::vector<RepeatedObservation>& repeated);

/// What keeps a calibration from being good: a stream of which more than a quarter repeats what was
/// measured at another pose, or with another current. Its sensor stood still while others did not.
std::vector<std::string> stillSensorsInWords(const std::vector<Sample>& samples,
                                             const std::vector<Observation>& observations,
                                             const std::vector<RepeatedObservation>& repeated,
                                             const EstimationOptions& options);

}  // namespace sac
