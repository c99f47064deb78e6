#include "repeated_observations.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

/// Share of the noise within which vectors are equal.
constexpr double kEqual = 1e-3;

/// What was measured, and a number that is nearly equal where it is.
struct Measured {
  std::array<double, 9> numbers{};
  double key = 0.0;
  double tolerance = 0.0;  ///< of each number
  std::size_t place = 0;
};

double stddevOf(double stated, double assumed) {
  return stated > 0.0 ? stated : assumed;
}

void setKey(Measured& measured) {
  // Weights without a common measure: only equal vectors have equal keys, but for rare chance.
  constexpr double kRatio = 0.7548776662466927;
  double weight = 1.0;
  for (const double number : measured.numbers) {
    measured.key += weight * number;
    weight *= kRatio;
  }
}

/// Those of one quantity that noise would tell apart, by their keys.
std::vector<Measured> measuredOf(const std::vector<Sample>& samples,
                                 const std::vector<Observation>& observations,
                                 Quantity quantity,
                                 const EstimationOptions& options) {
  constexpr double kStandsOut = 10.0;  // standard deviations
  std::vector<Measured> all;
  for (std::size_t place = 0; place < observations.size(); ++place) {
    if (observations[place].quantity != quantity) {
      continue;
    }
    const Sample& sample = samples[observations[place].sample];
    Measured measured;
    measured.place = place;
    if (quantity == Quantity::kTorque) {
      const double stddev = stddevOf(sample.torque_stddev, options.default_torque_stddev);
      if (sample.torque.norm() < kStandsOut * stddev) {
        continue;
      }
      std::copy_n(sample.torque.data(), 3, measured.numbers.begin());
      measured.tolerance = kEqual * stddev;
    } else {
      std::copy_n(sample.R_stator_rotor.data(), 9, measured.numbers.begin());
      measured.tolerance =
          kEqual * stddevOf(sample.orientation_stddev, options.default_orientation_stddev);
    }
    setKey(measured);
    all.push_back(measured);
  }
  std::sort(all.begin(), all.end(), [](const Measured& a, const Measured& b) {
    return a.key < b.key || (a.key == b.key && a.place < b.place);
  });
  return all;
}

bool areEqual(const Measured& a, const Measured& b) {
  const double tolerance = std::min(a.tolerance, b.tolerance);
  for (std::size_t k = 0; k < a.numbers.size(); ++k) {
    if (std::abs(a.numbers[k] - b.numbers[k]) > tolerance) {
      return false;
    }
  }
  return true;
}

void addRepeated(const std::vector<Measured>& by_key, std::vector<RepeatedObservation>& repeated) {
  constexpr double kSumOfWeights = 4.1;  // 1 / (1 − ratio)
  // Per measurement the first, by its key, that it is equal to; of that the earliest place.
  std::vector<std::size_t> groups(by_key.size());
  std::vector<std::size_t> first(by_key.size());
  for (std::size_t n = 0; n < by_key.size(); ++n) {
    groups[n] = n;
    first[n] = by_key[n].place;
    const double reach = kSumOfWeights * by_key[n].tolerance;
    for (std::size_t m = n; m-- > 0 && by_key[n].key - by_key[m].key <= reach;) {
      if (areEqual(by_key[n], by_key[m])) {
        groups[n] = groups[m];
        first[groups[n]] = std::min(first[groups[n]], by_key[n].place);
        break;
      }
    }
  }
  for (std::size_t n = 0; n < by_key.size(); ++n) {
    if (first[groups[n]] != by_key[n].place) {
      repeated.push_back({by_key[n].place, first[groups[n]]});
    }
  }
}

std::size_t countOf(const std::vector<Observation>& observations, Quantity quantity) {
  return static_cast<std::size_t>(
      std::count_if(observations.begin(), observations.end(), [quantity](const Observation& one) {
        return one.quantity == quantity;
      }));
}

}  // namespace

std::vector<RepeatedObservation> repeatedObservations(const std::vector<Sample>& samples,
                                                      const std::vector<Observation>& observations,
                                                      const EstimationOptions& options) {
  std::vector<RepeatedObservation> repeated;
  for (const Quantity quantity : {Quantity::kOrientation, Quantity::kTorque}) {
    addRepeated(measuredOf(samples, observations, quantity, options), repeated);
  }
  std::sort(repeated.begin(), repeated.end(), [](const auto& a, const auto& b) {
    return a.place < b.place;
  });
  return repeated;
}

std::vector<Observation> withoutRepeated(const std::vector<Observation>& observations,
                                         const std::vector<RepeatedObservation>& repeated) {
  std::vector<Observation> kept;
  auto next = repeated.begin();
  for (std::size_t n = 0; n < observations.size(); ++n) {
    if (next != repeated.end() && next->place == n) {
      ++next;
    } else {
      kept.push_back(observations[n]);
    }
  }
  return kept;
}

bool areWithoutNoise(const std::vector<Observation>& observations,
                     const std::vector<RepeatedObservation>& repeated,
                     const Estimate& estimate) {
  constexpr double kNoNoise = 1e-3;  // of the stated one
  return std::all_of(repeated.begin(), repeated.end(), [&](const RepeatedObservation& one) {
    const Quantity quantity = observations[one.place].quantity;
    return std::all_of(estimate.residuals.begin(),
                       estimate.residuals.end(),
                       [quantity](const ObservationResidual& residual) {
                         return residual.observation.quantity != quantity ||
                                residual.standardized < kNoNoise;
                       });
  });
}

std::string repeatedInWords(const std::vector<Sample>& samples,
                            const std::vector<Observation>& observations,
                            const std::vector<RepeatedObservation>& repeated) {
  constexpr std::size_t kMostNamed = 4;
  std::string text;
  for (const Quantity quantity : {Quantity::kOrientation, Quantity::kTorque}) {
    std::string pairs;
    std::size_t count = 0;
    for (const RepeatedObservation& one : repeated) {
      if (observations[one.place].quantity == quantity && count++ < kMostNamed) {
        pairs += (pairs.empty() ? "" : ", ") +
                 std::to_string(samples[observations[one.place].sample].id) + " that of " +
                 std::to_string(samples[observations[one.first].sample].id);
      }
    }
    if (count > 0) {
      text += format(" %zu of %zu %s repeat an earlier sample bit for bit (sample %s%s).",
                     count,
                     countOf(observations, quantity),
                     quantity == Quantity::kTorque ? "torques" : "orientations",
                     pairs.c_str(),
                     count > kMostNamed ? ", …" : "");
    }
  }
  return text.empty() ? text
                      : text +
                            " They are left out, for what is measured anew never repeats: look for "
                            "a sensor that stood still, rows that are doubled, or a recording that "
                            "was taken twice.";
}

}  // namespace sac
