#include "single_explanations.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <utility>

#include "explanation_words.hpp"
#include "orientation_hypotheses.hpp"
#include "posterior_fit.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "strength_screen.hpp"
#include "torque_hypotheses.hpp"

namespace sac {
namespace {

/// Of a squared misfit: single gross errors, which nothing here explains, have little weight.
constexpr double kMostCounted = 30.0;
/// Odds below it do not tell two causes apart [nats].
constexpr double kTieOfCauses = 5.0;
constexpr double kValuesOfObservation = 3.0;
/// Strengths of so many poles and coils are tried one by one.
constexpr std::size_t kMostStrengths = 3;

/// One cause after its fit.
struct Explanation {
  std::string cause;
  EffectSelection effects;  ///< that are modelled, its own among them
  Candidate correction;     ///< where it is none of the effects: a single factor
  double freedom = 0.0;     ///< number of its values
  PosteriorFit fit;
  std::vector<ParameterEstimate> estimates;  ///< its own values

  /// A sensor that is turned has one name, however little it is.
  std::string name() const {
    return cause == effect_name::kTorqueRegistration ? "torque_frame" : cause;
  }
  /// Bayesian information criterion: what the samples tell, less what so much freedom gains.
  double score() const {
    const double values = kValuesOfObservation * static_cast<double>(fit.squared_misfits.size());
    return fit.log_likelihood - 0.5 * freedom * std::log(values);
  }
  /// The same, with what is known of the parameters beforehand.
  double probability() const { return score() + fit.log_posterior - fit.log_likelihood; }
};

bool isOfMotion(const ParameterSpace& space, const std::string& effect) {
  for (const PlacedEffect& placed : space.effects().effects()) {
    if (placed.name == effect) {
      return placed.acts_on == LaboratoryEffect::ActsOn::kMotion;
    }
  }
  return true;
}

/// Tries all causes on one case.
class Explainer {
 public:
  Explainer(const WiringCase& described, const CalibrationConfig& config)
      : described_(described), config_(config) {
    base_ = fitted({}, config.effects);
  }

  std::vector<Diagnosis> run() {
    if (base_.squared_misfits.empty()) {
      return {};
    }
    tryEffects();
    tryScales();
    std::vector<Explanation> found;
    for (Explanation& explanation : tried_) {
      if (explains(explanation)) {
        found.push_back(std::move(explanation));
      }
    }
    return named(alike(std::move(found)));
  }

 private:
  PosteriorFit fitted(const Candidate& correction, const EffectSelection& effects) const {
    std::optional<Eigen::VectorXd> start;
    if (base_.x.size() > 0) {
      const ParameterSpace space(described_.actuator, effects);
      start = Eigen::VectorXd::Zero(space.size());
      start->head(space.effect()) = base_.x.head(space.effect());
    }
    return fitPosterior(described_,
                        correction,
                        FittedStream::kBoth,
                        config_,
                        ModelAllowance{0.0, 0.0},
                        start,
                        effects);
  }

  void tryEffects() {
    for (const std::string& effect : effectNames()) {
      if (config_.effects[effect] || !canHaveEffect(described_.actuator, effect)) {
        continue;
      }
      Explanation one;
      one.cause = effect;
      one.effects = config_.effects;
      one.effects[effect] = true;
      one.effects.setStddev(effect, 0.0);  // what is stated of it may be wrong
      const ParameterSpace space(described_.actuator, one.effects);
      if (isOfMotion(space, effect)) {
        continue;
      }
      one.fit = fitted({}, one.effects);
      takeEffect(space, std::move(one));
    }
  }

  /// With its values; of strengths also those of the poles or coils that stand out.
  void takeEffect(const ParameterSpace& space, Explanation one) {
    const Eigen::VectorXd values = space.reportedValues(one.fit.x);
    const Eigen::MatrixXd covariance = covarianceOf(one);
    const Eigen::VectorXd stddevs = space.reportedStddevs(one.fit.x, covariance);
    for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
      const Eigen::Index at = p - space.effect();
      if (space.effects().at(at).name == one.cause) {
        ParameterEstimate estimate;
        estimate.name = space.name(p);
        estimate.nominal = space.effects().nominalValue(at);
        estimate.value = values[p];
        estimate.stddev = stddevs[p];
        estimate.unit = space.unit(p);
        one.estimates.push_back(estimate);
      }
    }
    one.freedom = static_cast<double>(one.estimates.size());
    if (one.cause == effect_name::kPoleGains || one.cause == effect_name::kCoilGains) {
      tryStrengths(space, one, covariance);
    }
    tried_.push_back(std::move(one));
  }

  /// Of the poles or coils that stand out, one by one.
  void tryStrengths(const ParameterSpace& space,
                    const Explanation& all,
                    const Eigen::MatrixXd& covariance) {
    const auto strengths = outstandingStrengths(space, all.cause, all.fit.x, covariance);
    for (std::size_t n = 0; n < std::min(strengths.size(), kMostStrengths); ++n) {
      const auto [index, strength] = strengths[n];
      const double tolerance = config_.tolerance.effect;
      if (all.cause == effect_name::kPoleGains) {
        tryFactor(poleGain(index, strength, tolerance), "pole_" + numberText(index) + "/gain");
      } else {
        tryFactor(coilGain(index, strength, tolerance), "coil_" + numberText(index) + "/gain");
      }
    }
  }

  void tryScales() {
    for (const Hypothesis& hypothesis : jointHypotheses(described_.actuator, config_.tolerance)) {
      if (hypothesis.cause.rfind("joint_scale", 0) == 0) {
        const std::string joint = hypothesis.cause.substr(hypothesis.cause.find(':') + 1);
        tryFactor(hypothesis, "joint_" + joint + "/scale");
      }
    }
  }

  void tryFactor(const Hypothesis& factor, const std::string& name) {
    Explanation one;
    one.cause = factor.cause;
    one.effects = config_.effects;
    one.correction = {factor};
    one.freedom = 1.0;
    one.fit = fitted(one.correction, one.effects);
    ParameterEstimate estimate;
    estimate.name = name;
    estimate.value = one.fit.values[0] - 1.0;
    const Eigen::Index last = one.fit.x.size();
    estimate.stddev = std::sqrt(covarianceOf(one)(last, last));
    estimate.unit = "1";
    one.estimates = {estimate};
    tried_.push_back(std::move(one));
  }

  Eigen::MatrixXd covarianceOf(const Explanation& one) const {
    return posteriorCovariance(described_,
                               one.correction,
                               FittedStream::kBoth,
                               config_,
                               ModelAllowance{0.0, 0.0},
                               one.effects,
                               one.fit);
  }

  /// Whether samples tell of it, and it explains them.
  bool explains(const Explanation& one) const {
    const double gain = one.fit.log_likelihood - base_.log_likelihood;
    return gain > gainByChance(static_cast<Eigen::Index>(one.freedom)) &&
           std::any_of(one.estimates.begin(), one.estimates.end(), isSignificant) &&
           excess(one.fit) <= (1.0 - kExplainedShare) * excess(base_);
  }

  static double excess(const PosteriorFit& fit) {
    double sum = 0.0;
    for (const double misfit : fit.squared_misfits) {
      sum += std::min(misfit, kMostCounted) - kValuesOfObservation;
    }
    return std::max(0.0, sum);
  }

  /// The best, and those that explain as much; the most probable of them first.
  static std::vector<Explanation> alike(std::vector<Explanation> found) {
    double best = 0.0;
    for (std::size_t n = 0; n < found.size(); ++n) {
      best = n == 0 ? found[n].score() : std::max(best, found[n].score());
    }
    found.erase(std::remove_if(
                    found.begin(),
                    found.end(),
                    [best](const Explanation& one) { return one.score() < best - kTieOfCauses; }),
                found.end());
    std::stable_sort(found.begin(), found.end(), [](const Explanation& a, const Explanation& b) {
      return a.probability() > b.probability();
    });
    return found;
  }

  std::vector<Diagnosis> named(const std::vector<Explanation>& explanations) const {
    std::vector<Diagnosis> diagnoses;
    for (const Explanation& one : explanations) {
      std::string others;
      for (const Explanation& other : explanations) {
        if (&other != &one) {
          others += (others.empty() ? "" : ", ") + other.name();
        }
      }
      std::string message =
          valuesInWords(one.estimates) +
          explainsInWords(chiSquare(base_, one.fit), chiSquare(one.fit, one.fit)) + " " +
          remedy(one);
      if (!others.empty()) {
        message += " The samples are explained as well by " + others +
                   ": find out by other means which it is before you follow one of them.";
      }
      diagnoses.push_back({one.name(), message, one.fit.log_likelihood - base_.log_likelihood});
    }
    return diagnoses;
  }

  /// Reduced, of the observations that `judge` explains.
  static double chiSquare(const PosteriorFit& fit, const PosteriorFit& judge) {
    double sum = 0.0;
    double freedom = -static_cast<double>(fit.x.size() + fit.values.size());
    for (std::size_t n = 0; n < fit.squared_misfits.size(); ++n) {
      if (judge.squared_misfits[n] < kMostCounted) {
        sum += fit.squared_misfits[n];
        freedom += kValuesOfObservation;
      }
    }
    return sum / std::max(1.0, freedom);
  }

  static std::string remedy(const Explanation& one) {
    const std::string model = "odel it: effects: {" + one.cause + ": true} in calibration.yaml.";
    if (!one.correction.empty()) {
      return capitalised(one.correction.front().sentence(one.fit.values));
    }
    Eigen::VectorXd values(static_cast<Eigen::Index>(one.estimates.size()));
    for (Eigen::Index n = 0; n < values.size(); ++n) {
      values[n] = -one.estimates[static_cast<std::size_t>(n)].value;
    }
    std::string sentence;
    if (one.cause == effect_name::kTorqueRegistration) {
      sentence = torqueRotation(values, 0.0).sentence(values);
    } else if (one.cause == effect_name::kMarkerRegistration) {
      sentence = markerRotation(0.0).sentence(values);
    } else if (one.cause == effect_name::kTrackerRegistration) {
      sentence = trackerRotation(0.0).sentence(values);
    }
    return sentence.empty() ? "M" + model : capitalised(sentence) + " Or m" + model;
  }

  static std::string capitalised(std::string sentence) {
    sentence.front() = static_cast<char>(std::toupper(sentence.front()));
    return sentence;
  }

  const WiringCase& described_;
  const CalibrationConfig& config_;
  PosteriorFit base_;
  std::vector<Explanation> tried_;
};

}  // namespace

std::vector<Diagnosis> singleExplanations(const WiringCase& described,
                                          const CalibrationConfig& config) {
  return Explainer(described, config).run();
}

}  // namespace sac
