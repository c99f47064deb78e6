#include "frequent_outliers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {
namespace {

/// Observations that a common cause would spoil together.
struct Tally {
  std::size_t count = 0;
  std::size_t rejected = 0;
};

void count(const ObservationResidual& residual, Tally& tally) {
  ++tally.count;
  tally.rejected += residual.rejected ? 1 : 0;
}

/// Of orientations, then torques: those that lose more than a quarter to outliers, which accidents
/// do not come near; noise that is stated too small does.
std::vector<std::string> lostStreams(const Estimate& estimate) {
  constexpr std::size_t kLeast = 3;
  constexpr std::size_t kPart = 4;
  const std::array<const char*, 2> names{"orientations", "torques"};
  std::array<Tally, 2> streams;
  for (const ObservationResidual& residual : estimate.residuals) {
    count(residual, streams[residual.observation.quantity == Quantity::kOrientation ? 0 : 1]);
  }
  std::vector<std::string> words;
  for (std::size_t n = 0; n < streams.size(); ++n) {
    const Tally& stream = streams[n];
    if (stream.rejected >= kLeast && kPart * stream.rejected > stream.count) {
      words.push_back(
          format("%zu of %zu %s were left out as outliers, more than accidents are: is their noise "
                 "as their samples state it?",
                 stream.rejected,
                 stream.count,
                 names[n]));
    }
  }
  return words;
}

/// Whether a coil loses more torques than accidents take, which come at `rate`. Of half or more one
/// tells sooner: the few that are left fit wherever the coil then lies.
bool losesMoreThanByAccident(const Tally& coil, double rate, std::size_t coils) {
  constexpr double kChanceOfOne = 1e-3;
  constexpr std::size_t kLeast = 3;
  constexpr std::size_t kPart = 4;
  const std::size_t kept = coil.count - coil.rejected;
  const bool is_half = coil.rejected >= kept;
  const bool is_notable = coil.rejected >= kLeast && kPart * coil.rejected > coil.count;
  if (coil.rejected == 0 || kept == 0 || (!is_half && !is_notable)) {
    return false;
  }
  const double probability = binomialTail(coil.count, std::min(1.0, rate), coil.rejected);
  const double least = is_half ? kChanceOfOne : kChanceOfOne / static_cast<double>(coils);
  // Of two that contradict each other nobody can tell which is wrong, whatever the rate.
  return (is_half && kept == 1) || probability < least;
}

std::vector<std::string> lostCoils(const EstimationProblem& problem,
                                   const Estimate& estimate,
                                   const EstimationOptions& options) {
  std::vector<Tally> coils(problem.model->space().coils());
  Tally all;
  for (const ObservationResidual& residual : estimate.residuals) {
    if (residual.observation.quantity == Quantity::kOrientation) {
      continue;
    }
    count(residual, all);
    const Sample& sample = (*problem.samples)[residual.observation.sample];
    for (const Excitation& excitation : excitedCoils(sample, options.current_threshold)) {
      count(residual, coils[excitation.coil]);
    }
  }
  std::vector<std::string> words;
  for (std::size_t j = 0; j < coils.size(); ++j) {
    const Tally& coil = coils[j];
    const double rate = static_cast<double>(all.rejected - coil.rejected + 1) /
                        static_cast<double>(all.count - coil.count + 1);
    if (losesMoreThanByAccident(coil, rate, coils.size())) {
      words.push_back(
          format("%zu of %zu torques of coil %zu were left out as outliers, %s: check its current, "
                 "its leads and its strength, and measure it again.",
                 coil.rejected,
                 coil.count,
                 numberOf(j),
                 2 * coil.rejected >= coil.count ? "and the rest fits wherever it then lies"
                                                 : "more than accidents are"));
    }
  }
  return words;
}

}  // namespace

std::vector<std::string> frequentOutliers(const EstimationProblem& problem,
                                          const Estimate& estimate,
                                          const EstimationOptions& options) {
  std::vector<std::string> words = lostStreams(estimate);
  const std::vector<std::string> coils = lostCoils(problem, estimate, options);
  words.insert(words.end(), coils.begin(), coils.end());
  return words;
}

}  // namespace sac
