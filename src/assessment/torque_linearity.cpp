#include "spherical_actuator_calibration/assessment/torque_linearity.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/damped_descent.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/same_dwell.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

constexpr std::size_t kFewestSamples = 3;
/// Deviation and asymmetry are looked for around zero with this standard deviation; one that the
/// samples leave less certain than kMostUncertain is not told.
constexpr double kWidest = 1.0;
constexpr double kMostUncertain = 0.1;

/// Of a measured mean current [A]: half of the step in which the shipped amplifier tells it.
constexpr double kCurrentStddev = 5e-4;

// Unknowns: g, deviation, asymmetry, T₀.
constexpr Eigen::Index kDeviation = 3;
constexpr Eigen::Index kAsymmetry = 4;
constexpr Eigen::Index kTorqueAtZero = 5;
constexpr Eigen::Index kUnknowns = 8;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

enum class Law { kProportional, kBent };

/// Torques of one coil at one rest, and those without any current that were not taken off.
struct CoilAtRest {
  std::size_t coil = 0;
  std::vector<std::size_t> places;  ///< in the rest
};

double currentOf(const Sample& sample, std::size_t coil) {
  return sample.current[static_cast<Eigen::Index>(coil)];
}

/// The only coil that is excited; nothing for several. Without any, `coils`.
std::optional<std::size_t> onlyCoil(const Sample& sample, double threshold) {
  const std::vector<Excitation> excited = excitedCoils(sample, threshold);
  if (excited.size() > 1) {
    return std::nullopt;
  }
  return excited.empty() ? static_cast<std::size_t>(sample.current.size()) : excited.front().coil;
}

/// The coils of a rest that have enough torques.
std::vector<CoilAtRest> coilsAtRest(const std::vector<Sample>& rest, double threshold) {
  if (rest.size() < kFewestSamples) {
    return {};
  }
  const auto coils = static_cast<std::size_t>(rest.front().current.size());
  std::vector<std::vector<std::size_t>> of_coil(coils + 1);
  for (std::size_t n = 0; n < rest.size(); ++n) {
    if (const std::optional<std::size_t> coil = onlyCoil(rest[n], threshold)) {
      of_coil[*coil].push_back(n);
    }
  }
  std::vector<CoilAtRest> found;
  const std::vector<std::size_t>& without = of_coil.back();
  for (std::size_t coil = 0; coil < coils; ++coil) {
    std::vector<std::size_t>& excited = of_coil[coil];
    // One without current still has what was taken off the others.
    const auto is_whole = [&](std::size_t n) { return rest[n].torque_shared_stddev == 0.0; };
    const auto whole = std::stable_partition(
        excited.begin(), excited.end(), [&](std::size_t n) { return !is_whole(n); });
    if (whole == excited.begin() && !excited.empty()) {
      excited.insert(excited.end(), without.begin(), without.end());
    } else {
      excited.erase(whole, excited.end());
    }
    if (excited.size() >= kFewestSamples) {
      found.push_back({coil, excited});
    }
  }
  return found;
}

/// χ² of the torques of one coil at one rest, and of what is known beforehand.
class LinearityFit {
 public:
  using Point = Unknowns;

  LinearityFit(const std::vector<Sample>& rest, const CoilAtRest& at, double default_torque_stddev)
      : coil_(at.coil), default_torque_stddev_(default_torque_stddev) {
    for (const std::size_t place : at.places) {
      samples_.push_back(&rest[place]);
    }
    double largest_torque = default_torque_stddev_;
    for (const Sample* sample : samples_) {
      full_ = std::max(full_, std::abs(currentOf(*sample, coil_)));
      largest_torque = std::max(largest_torque, sample->torque.norm());
      shared_stddev_ = std::max(shared_stddev_, sample->torque_shared_stddev);
    }
    // Wherever nothing was taken off, what is without current may be anything.
    constexpr double kAnything = 100.0;
    stddev_at_zero_ = isZeroTakenOff() ? shared_stddev_ : kAnything * largest_torque;
  }

  std::optional<TorqueLinearity> result() {
    const double proportional = minimise(Law::kProportional);
    const double bent = minimise(Law::kBent);
    const Eigen::MatrixXd information = normalEquations(x_).information;
    const Unknowns stddevs = Cholesky(information).inverse().diagonal().cwiseSqrt();
    if (!(stddevs[kDeviation] <= kMostUncertain)) {
      return std::nullopt;
    }
    TorqueLinearity found;
    found.coil = coil_;
    found.full_current = full_;
    for (const Sample* sample : samples_) {
      found.samples.push_back(sample->id);
      found.currents.push_back(currentOf(*sample, coil_));
    }
    const bool tells_asymmetry = stddevs[kAsymmetry] <= kMostUncertain;
    found.chi_square = proportional;
    found.degrees_of_freedom = freedom();
    found.probability = chiSquareProbability(found.degrees_of_freedom, proportional);
    const int left = freedom() - (tells_asymmetry ? 2 : 1);
    found.law_probability = chiSquareProbability(left, bent);
    // So few torques cannot show that a misfit is more than noise brings: any widens.
    const double widened = std::sqrt(std::max(1.0, bent / left));
    found.deviation = {x_[kDeviation], widened * stddevs[kDeviation]};
    if (tells_asymmetry) {
      found.asymmetry = UncertainValue{x_[kAsymmetry], widened * stddevs[kAsymmetry]};
    }
    return found;
  }

  double cost(const Unknowns& x) const { return normalEquations(x).cost; }

  NormalEquations normalEquations(const Unknowns& x) const {
    InformationSum sum(kUnknowns);
    const Eigen::Vector3d g = x.head<3>();
    for (const Sample* sample : samples_) {
      const double share = currentOf(*sample, coil_) / full_;
      const double bent = 1.0 + x[kDeviation] * std::abs(share) + x[kAsymmetry] * share;
      Eigen::Matrix<double, 3, kUnknowns> J;
      J.leftCols<3>() = share * bent * Eigen::Matrix3d::Identity();
      J.col(kDeviation) = share * std::abs(share) * g;
      J.col(kAsymmetry) = share * share * g;
      if (law_ == Law::kProportional) {
        J.middleCols<2>(kDeviation).setZero();
      }
      J.rightCols<3>().setIdentity();
      const Cholesky3 noise(noiseOf(*sample));
      const Eigen::Vector3d residual = share * bent * g + x.tail<3>() - sample->torque;
      sum.addDense(noise.half(J).eval(), noise.half(residual).eval());
    }
    constexpr Eigen::Index kKnown = kUnknowns - kDeviation;
    Eigen::Matrix<double, kKnown, 1> weight;
    weight << 1.0 / kWidest, 1.0 / kWidest, Eigen::Vector3d::Constant(1.0 / stddev_at_zero_);
    Eigen::Matrix<double, kKnown, kUnknowns> known;
    known << Eigen::Matrix<double, kKnown, 3>::Zero(), Eigen::MatrixXd(weight.asDiagonal());
    sum.addDense(known, weight.cwiseProduct(x.tail<kKnown>()).eval());
    return {sum.squaredMisfit(), sum.gradient(), sum.information()};
  }

  static Unknowns moved(const Unknowns& x, const Eigen::VectorXd& step) { return x + step; }

  static double nothing(const Unknowns& x) {
    constexpr double kNothing = 1e-12;
    return kNothing * (1.0 + x.norm());
  }

 private:
  bool isZeroTakenOff() const { return shared_stddev_ > 0.0; }

  /// Of proportionality.
  int freedom() const {
    const int values = 3 * static_cast<int>(samples_.size());
    return values - (isZeroTakenOff() ? 3 : 6);
  }

  /// From where the last fit ended. Returns χ².
  double minimise(Law law) {
    constexpr int kRounds = 4;  // of the noise, which hardly follows the fit
    law_ = law;
    DescentOptions options;
    options.is_smooth = true;
    for (int round = 0; round < kRounds; ++round) {
      torque_at_full_ = x_.head<3>();
      std::vector<Unknowns> path{x_};
      descend(*this, options, path);
      x_ = path.back();
    }
    return cost(x_);
  }

  /// Of the torque itself, and of the current that goes with it.
  Eigen::Matrix3d noiseOf(const Sample& sample) const {
    const Eigen::Vector3d& g = torque_at_full_;
    const double stated =
        sample.torque_stddev > 0.0 ? sample.torque_stddev : default_torque_stddev_;
    const double shared = sample.torque_shared_stddev;
    constexpr double kLeastPart = 1e-6;  // rounding of what is stated
    const double own = std::max(stated * stated - shared * shared, kLeastPart * stated * stated);
    const double relative = kCurrentStddev / full_;
    return own * Eigen::Matrix3d::Identity() + relative * relative * g * g.transpose();
  }

  const std::size_t coil_;
  std::vector<const Sample*> samples_;
  const double default_torque_stddev_;
  double full_ = 0.0;
  double shared_stddev_ = 0.0;
  double stddev_at_zero_ = 0.0;
  Law law_ = Law::kProportional;
  Eigen::Vector3d torque_at_full_ = Eigen::Vector3d::Zero();  ///< as noise sees it [N·m]
  Unknowns x_ = Unknowns::Zero();
};

std::string percent(const UncertainValue& share) {
  // As many decimals as give the uncertainty two digits.
  const int digits = static_cast<int>(std::floor(std::log10(100.0 * share.stddev)));
  const int decimals = std::clamp(1 - digits, 0, 6);
  return format("%.*f ± %.*f %%", decimals, 100.0 * share.value, decimals, 100.0 * share.stddev);
}

}  // namespace

bool TorqueLinearity::isProportional() const {
  return probability >= kLeastProbability;
}

LinearitySearch::LinearitySearch(const EstimationOptions& options)
    : current_threshold_(options.current_threshold),
      default_torque_stddev_(options.default_torque_stddev) {}

void LinearitySearch::add(const Sample& sample) {
  if (!rest_.empty() && !isSameDwell(rest_.front(), sample)) {
    best_ = best();
    rest_.clear();
    of_coil_.clear();
  }
  if (sample.has_torque) {
    rest_.push_back(sample);
  }
}

std::optional<TorqueLinearity> LinearitySearch::best() {
  fitRest();
  std::optional<TorqueLinearity> best = best_;
  for (const auto& [coil, found] : of_coil_) {
    keepBetter(found.linearity, best);
  }
  return best;
}

/// Fits again what the samples since have changed.
void LinearitySearch::fitRest() {
  std::map<std::size_t, Found> before = std::move(of_coil_);
  of_coil_.clear();
  for (CoilAtRest& at : coilsAtRest(rest_, current_threshold_)) {
    Found& found = of_coil_[at.coil];
    found = std::move(before[at.coil]);
    if (found.places != at.places) {
      found.linearity = LinearityFit(rest_, at, default_torque_stddev_).result();
      found.places = std::move(at.places);
    }
  }
}

void LinearitySearch::keepBetter(const std::optional<TorqueLinearity>& found,
                                 std::optional<TorqueLinearity>& best) {
  if (found && (!best || found->deviation.stddev < best->deviation.stddev)) {
    best = found;
  }
}

std::optional<TorqueLinearity> torqueLinearity(const std::vector<Sample>& samples,
                                               const CalibrationConfig& config) {
  LinearitySearch search(config.estimation);
  for (const Sample& sample : samples) {
    search.add(sample);
  }
  return search.best();
}

std::string describe(const std::optional<TorqueLinearity>& linearity) {
  if (!linearity) {
    return "Whether torque is proportional to current is not told: measure one coil at three "
           "currents in one rest, such as full, half, and full with the other sign.";
  }
  std::string currents;
  for (const double current : linearity->currents) {
    currents += format("%s%.2f", currents.empty() ? "" : ", ", current);
  }
  std::string text = linearity->isProportional() ? "Torque is proportional to current: coil "
                                                 : "Torque is not proportional to current: coil ";
  text += format("%zu at %s A deviates by ", numberOf(linearity->coil), currents.c_str());
  text += percent(linearity->deviation) + format(" at %.2f A", linearity->full_current);
  if (linearity->asymmetry) {
    text += ", a positive current by " + percent(*linearity->asymmetry) +
            " from the mean of both signs";
  }
  text += format(" (probability %.2g if it is proportional).", linearity->probability);
  if (linearity->law_probability < kLeastProbability) {
    text +=
        " Its torques follow no such law either: did the rotor move under them, or the bias "
        "drift?";
  }
  return text;
}

}  // namespace sac
