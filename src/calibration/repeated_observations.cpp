#include "repeated_observations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

/// Share of the noise within which vectors are equal.
constexpr double kEqual = 1e-3;

/// A measurement by a number that is nearly equal where it is: what was measured is in its sample.
struct Keyed {
  double key = 0.0;
  std::uint32_t place = 0;  ///< among the observations
};

double stddevOf(double stated, double assumed) {
  return stated > 0.0 ? stated : assumed;
}

/// The sum of the weights of keyOf(): so many tolerances are keys of equal vectors apart at most.
constexpr double kSumOfWeights = 4.1;  // 1 / (1 − ratio)

/// The measurements of one quantity.
class Measurements {
 public:
  using Numbers = std::array<double, 9>;

  Measurements(const std::vector<Sample>& samples,
               const std::vector<Observation>& observations,
               Quantity quantity,
               const EstimationOptions& options)
      : samples_(samples), observations_(observations), quantity_(quantity), options_(options) {}

  /// Those that noise would tell apart, by their keys.
  std::vector<Keyed> sorted() const {
    std::vector<Keyed> all;
    all.reserve(static_cast<std::size_t>(
        std::count_if(observations_.begin(), observations_.end(), [&](const Observation& one) {
          return one.quantity == quantity_;
        })));
    for (std::size_t place = 0; place < observations_.size(); ++place) {
      const auto at = static_cast<std::uint32_t>(place);
      if (observations_[place].quantity == quantity_ && standsOut(at)) {
        all.push_back({keyOf(at), at});
      }
    }
    std::sort(all.begin(), all.end(), [](const Keyed& a, const Keyed& b) {
      return a.key < b.key || (a.key == b.key && a.place < b.place);
    });
    return all;
  }

  bool standsOut(std::uint32_t place) const {
    constexpr double kStandsOut = 10.0;  // standard deviations
    const Sample& sample = this->sample(place);
    return quantity_ != Quantity::kTorque || sample.torque.norm() >= kStandsOut * stddev(sample);
  }

  double keyOf(std::uint32_t place) const {
    // Weights without a common measure: only equal vectors have equal keys, but for rare chance.
    constexpr double kRatio = 0.7548776662466927;
    double key = 0.0;
    double weight = 1.0;
    for (const double number : numbers(place)) {
      key += weight * number;
      weight *= kRatio;
    }
    return key;
  }

  bool areEqual(std::uint32_t a, std::uint32_t b) const {
    const double most = std::min(tolerance(a), tolerance(b));
    const Numbers of_a = numbers(a);
    const Numbers of_b = numbers(b);
    for (std::size_t k = 0; k < of_a.size(); ++k) {
      if (std::abs(of_a[k] - of_b[k]) > most) {
        return false;
      }
    }
    return true;
  }

  /// Of each number.
  double tolerance(std::uint32_t place) const { return kEqual * stddev(sample(place)); }

 private:
  const Sample& sample(std::uint32_t place) const { return samples_[observations_[place].sample]; }

  double stddev(const Sample& sample) const {
    return quantity_ == Quantity::kTorque
               ? stddevOf(sample.torque_stddev, options_.default_torque_stddev)
               : stddevOf(sample.orientation_stddev, options_.default_orientation_stddev);
  }

  Numbers numbers(std::uint32_t place) const {
    const Sample& sample = this->sample(place);
    Numbers numbers{};
    if (quantity_ == Quantity::kTorque) {
      std::copy_n(sample.torque.data(), 3, numbers.begin());
    } else {
      std::copy_n(sample.R_stator_rotor.data(), 9, numbers.begin());
    }
    return numbers;
  }

  const std::vector<Sample>& samples_;
  const std::vector<Observation>& observations_;
  const Quantity quantity_;
  const EstimationOptions& options_;
};

void addRepeated(const Measurements& measurements, std::vector<RepeatedObservation>& repeated) {
  const std::vector<Keyed> by_key = measurements.sorted();
  // Per measurement the first, by its key, that it is equal to; of that the earliest place.
  std::vector<std::uint32_t> groups(by_key.size());
  std::vector<std::uint32_t> first(by_key.size());
  for (std::size_t n = 0; n < by_key.size(); ++n) {
    groups[n] = static_cast<std::uint32_t>(n);
    first[n] = by_key[n].place;
    const double reach = kSumOfWeights * measurements.tolerance(by_key[n].place);
    for (std::size_t m = n; m-- > 0 && by_key[n].key - by_key[m].key <= reach;) {
      if (measurements.areEqual(by_key[n].place, by_key[m].place)) {
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

/// Whether what was measured twice cannot have been the same.
bool areApart(const Sample& a, const Sample& b, Quantity quantity, double current_threshold) {
  constexpr double kMoved = 0.02;  // [rad] which no sensor overlooks
  if ((a.joint_position - b.joint_position).norm() > kMoved) {
    return true;
  }
  return quantity == Quantity::kTorque &&
         (a.current - b.current).lpNorm<Eigen::Infinity>() > current_threshold;
}

const char* nameOf(Quantity quantity) {
  return quantity == Quantity::kTorque ? "torques" : "orientations";
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
    addRepeated(Measurements(samples, observations, quantity, options), repeated);
  }
  std::sort(repeated.begin(), repeated.end(), [](const auto& a, const auto& b) {
    return a.place < b.place;
  });
  return repeated;
}

std::optional<std::size_t> RepeatSearch::add(const std::vector<Sample>& samples,
                                             const std::vector<Observation>& observations) {
  const auto place = static_cast<std::uint32_t>(observations.size() - 1);
  const Quantity quantity = observations.back().quantity;
  const Measurements measurements(samples, observations, quantity, options_);
  if (!measurements.standsOut(place)) {
    return std::nullopt;
  }
  std::multimap<double, std::uint32_t>& by_key =
      quantity == Quantity::kTorque ? torques_ : orientations_;
  const double key = measurements.keyOf(place);
  const double reach = kSumOfWeights * measurements.tolerance(place);
  const auto end = by_key.upper_bound(key + reach);
  const auto earlier = std::find_if(by_key.lower_bound(key - reach), end, [&](const auto& one) {
    return measurements.areEqual(place, one.second);
  });
  if (earlier != end) {
    return earlier->second;
  }
  // Of those that are equal the first alone: a sensor that stands still gives thousands.
  by_key.emplace(key, place);
  return std::nullopt;
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
      text += format(
          " %zu of %zu %s repeat an earlier sample, to a thousandth of the noise (sample %s%s).",
          count,
          countOf(observations, quantity),
          nameOf(quantity),
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

std::vector<std::string> stillSensorsInWords(const std::vector<Sample>& samples,
                                             const std::vector<Observation>& observations,
                                             const std::vector<RepeatedObservation>& repeated,
                                             const EstimationOptions& options) {
  constexpr std::size_t kLeast = 3;
  constexpr std::size_t kPart = 4;
  std::vector<std::string> words;
  for (const Quantity quantity : {Quantity::kOrientation, Quantity::kTorque}) {
    const auto still = static_cast<std::size_t>(
        std::count_if(repeated.begin(), repeated.end(), [&](const RepeatedObservation& one) {
          return observations[one.place].quantity == quantity &&
                 areApart(samples[observations[one.place].sample],
                          samples[observations[one.first].sample],
                          quantity,
                          options.current_threshold);
        }));
    const std::size_t all = countOf(observations, quantity);
    if (still >= kLeast && kPart * still > all) {
      words.push_back(
          format("%zu of %zu %s are those of another pose or current: their sensor "
                 "stood still; look at its driver and its link, and measure again.",
                 still,
                 all,
                 nameOf(quantity)));
    }
  }
  return words;
}

}  // namespace sac
