#include "single_effects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "coordinate_elimination.hpp"
#include "effect_candidates.hpp"
#include "score_sums.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/same_dwell.hpp"
#include "untold_effect.hpp"

namespace sac {
namespace {

constexpr double kChance = 2e-4;  // of any finding, among all that is tried
/// Findings whose probabilities are closer than by this factor cannot be told apart.
constexpr double kAlike = 1e-2;

/// What one test found.
struct Score {
  double square = 0.0;  ///< χ²
  int freedom = 0;      ///< 0: the observations cannot tell it
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

/// Below which information is rounding, or tells nothing. `before`: of columns, before the
/// coordinates made up for what they can.
double leastInformation(const Eigen::VectorXd& before, double unobservable_stddev) {
  constexpr double kLeastShare = 1e-5;  // less is left by rounding
  return std::max(kLeastShare * before.maxCoeff(),
                  1.0 / (unobservable_stddev * unobservable_stddev));
}

/// `information` and `gradient` of k columns after the coordinates were eliminated; `before`: their
/// information without that.
Score scoreOf(const Eigen::MatrixXd& information,
              const Eigen::VectorXd& gradient,
              const Eigen::VectorXd& before,
              double unobservable_stddev) {
  const double least = leastInformation(before, unobservable_stddev);
  Score score;
  const Cholesky factor(information);
  if (factor.isPositive()) {
    score.covariance = factor.inverse();
    if (score.covariance.trace() * least < 1.0) {  // no eigenvalue is less
      score.value = -score.covariance * gradient;
      score.square = -gradient.dot(score.value);
      score.freedom = static_cast<int>(gradient.size());
      return score;
    }
  }
  const SymmetricEigen spectrum = symmetricEigen(information);
  score.value = Eigen::VectorXd::Zero(gradient.size());
  score.covariance = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  for (Eigen::Index k = 0; k < gradient.size(); ++k) {
    const double weight = spectrum.values[k];
    if (weight > least) {
      const Eigen::VectorXd direction = spectrum.vectors.col(k);
      const double along = direction.dot(gradient);
      score.square += along * along / weight;
      score.value -= along / weight * direction;
      score.covariance += direction * direction.transpose() / weight;
      ++score.freedom;
    }
  }
  return score;
}

/// A finding with what belongs to it.
struct Finding {
  std::string name;
  std::string unit;
  std::string advice;
  std::vector<double> scales;
  bool is_step = false;
  Score score = {};
  double probability = 1.0;      ///< of this test alone, 1 where nobody would wonder
  Eigen::VectorXd crossed = {};  ///< its column's with the coordinates
};

/// "(0.52, 0.48, -0.31) ± (0.07, 0.06, 0.06) mrad"
std::string valueInWords(const Finding& finding, double noise_scale) {
  const bool is_ratio = finding.unit == "1";
  const double unit = is_ratio ? 1e2 : 1e3;
  std::string values;
  std::string stddevs;
  const std::size_t count = finding.scales.size();
  for (std::size_t k = 0; k < count; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const double scale = unit * finding.scales[k];
    const double stddev = noise_scale * std::sqrt(finding.score.covariance(at, at));
    values += (k == 0 ? "" : ", ") + format("%.3g", scale * finding.score.value[at]);
    stddevs += (k == 0 ? "" : ", ") + format("%.2g", scale * stddev);
  }
  return (count == 1 ? values + " ± " + stddevs : "(" + values + ") ± (" + stddevs + ")") +
         (is_ratio ? " %" : " m" + finding.unit);
}

/// Misfit of all observations, or of one stream.
struct Stream {
  double squares = 0.0;
  double freedom = 0.0;
  double limit = 0.0;  ///< squares beyond it are none of chance
};

/// All, torques, orientations.
std::array<Stream, 3> streamsOf(const Estimate& estimate) {
  constexpr double kSignificance = 0.01;
  std::array<Stream, 3> streams;
  streams[0].freedom = estimate.degrees_of_freedom;
  streams[0].squares = estimate.reduced_chi_square * streams[0].freedom;
  for (const ObservationResidual& residual : estimate.residuals) {
    if (!residual.rejected) {
      Stream& own = streams[residual.observation.quantity == Quantity::kTorque ? 1 : 2];
      own.squares += 3.0 * residual.standardized * residual.standardized;
      own.freedom += 3.0;
    }
  }
  for (Stream& stream : streams) {
    stream.limit = stream.freedom > 0.0 ? chiSquareLimit(stream.freedom, kSignificance) : 0.0;
  }
  return streams;
}

/// Poses at which torques were measured.
std::size_t torquePoses(const EstimationProblem& problem) {
  std::size_t poses = 0;
  const Sample* last = nullptr;
  for (const Observation& observation : problem.observations) {
    const Sample& sample = (*problem.samples)[observation.sample];
    if (observation.quantity == Quantity::kTorque) {
      poses += last == nullptr || !isSameDwell(*last, sample) ? 1U : 0U;
      last = &sample;
    }
  }
  return poses;
}

/// All score tests of one estimate.
class Tests {
 public:
  Tests(const EstimationProblem& problem,
        const Estimate& estimate,
        const EstimationOptions& options,
        const MotionInformation* beside)
      : problem_(problem),
        estimate_(estimate),
        options_(options),
        columns_(*problem.model),
        effects_(effectCandidates(columns_)),
        steps_(stepCandidates(columns_)),
        sums_(scoreSums(problem, estimate, options, columns_, effects_, steps_)),
        elimination_(problem, estimate, options, sums_.all, beside),
        streams_(streamsOf(estimate)),
        poses_(torquePoses(problem)) {}

  std::optional<SingleEffect> strongest() {
    tryEffects();
    trySteps();
    if (findings_.empty()) {
      return std::nullopt;
    }
    const auto is_less = [](const Finding& a, const Finding& b) {
      return a.probability < b.probability;
    };
    const double least = std::min_element(findings_.begin(), findings_.end(), is_less)->probability;
    // What holds for the whole session explains more simply than what steps in it.
    std::stable_sort(findings_.begin(), findings_.end(), [&](const Finding& a, const Finding& b) {
      const auto rank = [&](const Finding& one) {
        return one.probability > least / kAlike ? 2 : (one.is_step ? 1 : 0);
      };
      return rank(a) != rank(b) ? rank(a) < rank(b) : is_less(a, b);
    });
    const Finding& best = findings_.front();
    const double probability = std::min(1.0, static_cast<double>(tests_) * best.probability);
    if (probability > kChance) {
      return std::nullopt;
    }
    return SingleEffect{best.name, sentence(best, probability), probability};
  }

  /// The usual mistake that would do most without being told, among what strongest() tried.
  std::string untold() const { return most_untold_ > kToldFrom ? untold_ : std::string(); }

 private:
  void tryEffects() {
    for (const EffectCandidate& candidate : effects_) {
      const Eigen::Index size = candidate.size();
      Eigen::MatrixXd crossed(sums_.all.coordinates(), size);
      Eigen::MatrixXd information(size, size);
      Eigen::VectorXd gradient(size);
      for (Eigen::Index a = 0; a < size; ++a) {
        crossed.col(a) = sums_.all.crossed(candidate.first + a);
        gradient[a] = sums_.all.gradient(candidate.first + a);
        for (Eigen::Index b = 0; b < size; ++b) {
          information(a, b) = sums_.all.between(candidate.first + a, candidate.first + b);
        }
      }
      const Eigen::MatrixXd halves = elimination_.half(crossed);
      Finding finding{candidate.name, candidate.unit, candidate.advice, candidate.scales};
      finding.score = scoreAfter(halves, information, gradient);
      judge(finding);
      if (candidate.first >= columns_.space().size()) {  // not modelled, so within no stated size
        notePower({candidate,
                   information - halves.transpose() * halves,
                   leastInformation(information.diagonal(), options_.unobservable_stddev),
                   poses_},
                  crossed);
      }
      if (finding.score.freedom > 0) {
        finding.crossed = crossed * finding.score.value;
        findings_.push_back(std::move(finding));
      }
    }
  }

  void notePower(const TestedEffect& effect, const Eigen::MatrixXd& crossed) {
    const std::optional<UntoldEffect> one = untoldEffect(effect);
    if (!one) {
      return;
    }
    const double shift = mostShift(elimination_.covarianceTimes(crossed * one->value));
    if (shift <= most_untold_) {
      return;
    }
    most_untold_ = shift;
    const bool is_ratio = effect.candidate.unit == "1";
    untold_ = format(
        "%s of %.3g %s would not show in so few samples (%.1f standard deviations, told from %.0f "
        "on), and shift parameters by up to %.0f of theirs: take %.1f times as many, or %s.",
        effect.candidate.name.c_str(),
        (is_ratio ? 1e2 : 1e3) * one->size,
        is_ratio ? "%" : "mrad",
        one->told,
        kToldFrom,
        shift,
        std::pow(kToldFrom / one->told, 2),
        effect.candidate.advice.c_str());
  }

  /// Of k columns once the coordinates have made up for what they can. `halves`: of the columns;
  /// `information` and `gradient`: of them before.
  template <typename Halves, typename Information, typename Gradient>
  Score scoreAfter(const Halves& halves,
                   const Information& information,
                   const Gradient& gradient) const {
    return scoreOf(information - halves.transpose().lazyProduct(halves),
                   gradient - halves.transpose() * elimination_.halfGradient(),
                   information.diagonal(),
                   options_.unobservable_stddev);
  }

  /// The most significant step of each kind.
  void trySteps() {
    std::vector<Finding> best(steps_.size());
    Eigen::MatrixXd crossed;
    Eigen::MatrixXd halves;
    for (const ScoreSums::Later& later : sums_.later) {
      // From one time to the next few coils are measured, and all others stay as they were.
      halves = crossed.size() == 0
                   ? elimination_.half(later.crossed)
                   : Eigen::MatrixXd(halves + elimination_.half(later.crossed - crossed));
      crossed = later.crossed;
      Eigen::Index first = 0;
      for (std::size_t n = 0; n < steps_.size(); ++n) {
        const Eigen::Index count = steps_[n].count;
        Finding finding;
        finding.score = scoreAfter(halves.middleCols(first, count),
                                   later.information.block(first, first, count, count),
                                   later.gradient.segment(first, count));
        judge(finding);
        if (finding.probability < 1.0 && finding.probability <= best[n].probability) {
          finding.name = steps_[n].name + " after sample " + std::to_string(later.after);
          finding.crossed = later.crossed.middleCols(first, count) * finding.score.value;
          best[n] = std::move(finding);
        }
        first += count;
      }
    }
    for (std::size_t n = 0; n < steps_.size(); ++n) {
      if (Finding& finding = best[n]; finding.score.freedom > 0) {
        finding.unit = "rad";
        finding.advice =
            "was something touched or loose there? Calibrate from the samples before it or after "
            "it alone";
        finding.scales.assign(static_cast<std::size_t>(steps_[n].count), 1.0);
        finding.is_step = true;
        findings_.push_back(std::move(finding));
      }
    }
  }

  void judge(Finding& finding) {
    if (finding.score.freedom > 0) {
      ++tests_;
      const double square = finding.score.square / noiseWithout(finding.score.square);
      if (square > finding.score.freedom) {  // three of ten times chance shows as much
        finding.probability = chiSquareProbability(finding.score.freedom, square);
      }
    }
  }

  /// Factor on the stated variances, at least 1, by what of the misfit an effect does not explain:
  /// of all observations, or of the stream that fits worse.
  double noiseWithout(double explained) const {
    double noise = 1.0;
    for (const Stream& stream : streams_) {
      const double rest = stream.squares - explained;
      if (stream.freedom > 0.0 && rest > stream.limit) {
        noise = std::max(noise, rest / stream.freedom);
      }
    }
    return noise;
  }

  std::string sentence(const Finding& best, double probability) const {
    std::string others;
    constexpr std::size_t kMostNamed = 3;
    for (std::size_t n = 1; n < std::min(findings_.size(), kMostNamed + 1); ++n) {
      if (findings_[n].probability < findings_[0].probability / kAlike) {
        others += (others.empty() ? " It may as well be " : ", or ") + findings_[n].name;
      }
    }
    return format(
        "The residuals show %s = %s, which is not modelled (by chance: %.1g): it shifts "
        "parameters by up to %.1f standard deviations. Mend it: %s.%s%s",
        best.name.c_str(),
        valueInWords(best, std::sqrt(noiseWithout(best.score.square))).c_str(),
        std::max(probability, std::numeric_limits<double>::min()),
        mostShift(elimination_.covarianceTimes(best.crossed)),
        best.advice.c_str(),
        others.c_str(),
        others.empty() ? "" : ".");
  }

  double mostShift(const Eigen::VectorXd& shift) const {
    double most = 0.0;
    for (const Eigen::Index p : problem_.free) {
      const double variance = estimate_.belief.covariance(p, p);
      if (variance > 0.0 &&
          !std::binary_search(estimate_.unobservable.begin(), estimate_.unobservable.end(), p)) {
        most = std::max(most, std::abs(shift[p]) / std::sqrt(variance));
      }
    }
    return most;
  }

  const EstimationProblem& problem_;
  const Estimate& estimate_;
  const EstimationOptions& options_;
  FurtherColumns columns_;
  std::vector<EffectCandidate> effects_;
  std::vector<StepCandidate> steps_;
  ScoreSums sums_;
  CoordinateElimination elimination_;
  std::array<Stream, 3> streams_;
  std::size_t poses_;
  std::vector<Finding> findings_;
  std::string untold_;
  double most_untold_ = 0.0;  ///< standard deviations by which it shifts a parameter
  std::size_t tests_ = 0;
};

}  // namespace

EffectEvidence effectEvidence(const EstimationProblem& problem,
                              const Estimate& estimate,
                              const EstimationOptions& options,
                              const MotionEvidence* motion) {
  std::optional<MotionInformation> beside;
  if (motion != nullptr) {
    beside = ownInformation(problem.model->space(), *motion);
  }
  Tests tests(problem, estimate, options, beside ? &*beside : nullptr);
  EffectEvidence evidence;
  evidence.found = tests.strongest();
  evidence.untold = tests.untold();
  return evidence;
}

}  // namespace sac
