#include "single_effects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "effect_candidates.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"

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

/// `information` and `gradient` of k columns after the coordinates were eliminated; `before`: their
/// information without that.
Score scoreOf(const Eigen::MatrixXd& information,
              const Eigen::VectorXd& gradient,
              const Eigen::VectorXd& before,
              double unobservable_stddev) {
  constexpr double kLeastShare = 1e-5;  // less is left by rounding
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(information);
  const double least =
      std::max(kLeastShare * before.maxCoeff(), 1.0 / (unobservable_stddev * unobservable_stddev));
  Score score;
  score.value = Eigen::VectorXd::Zero(gradient.size());
  score.covariance = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  for (Eigen::Index k = 0; k < gradient.size(); ++k) {
    const double weight = spectrum.eigenvalues()[k];
    if (weight > least) {
      const Eigen::VectorXd direction = spectrum.eigenvectors().col(k);
      const double along = direction.dot(gradient);
      score.square += along * along / weight;
      score.value -= along / weight * direction;
      score.covariance += direction * direction.transpose() / weight;
      ++score.freedom;
    }
  }
  return score;
}

/// What the coordinates can make up for: the covariance that they have from observations and what
/// was known of them, and the gradient of all of it.
class Elimination {
 public:
  Elimination(const EstimationProblem& problem,
              const Estimate& estimate,
              const EstimationOptions& options,
              const ScoreSums& sums) {
    const ParameterSpace& space = problem.model->space();
    const Eigen::Index P = space.size();
    Eigen::MatrixXd information = sums.information.topLeftCorner(P, P);
    gradient_ = sums.gradient.head(P);
    for (const Eigen::Index p : problem.free) {
      const double stated =
          p < space.effect() ? 0.0 : space.effects().statedVariance(p - space.effect());
      if (stated > 0.0) {
        information(p, p) += 1.0 / stated;
        gradient_[p] += estimate.belief.x[p] / stated;
      }
    }
    covariance_ = Eigen::MatrixXd::Zero(P, P);
    const double open = options.unobservable_stddev * options.unobservable_stddev;
    eliminate(problem, information, open);
  }

  const Eigen::MatrixXd& covariance() const { return covariance_; }
  /// Where the coordinates would go.
  Eigen::VectorXd step() const { return -covariance_ * gradient_; }

 private:
  /// `open`: variance of a free coordinate beside what the observations tell of it, where it stays
  /// near where it is.
  void eliminate(const EstimationProblem& problem,
                 const Eigen::MatrixXd& information,
                 double open) {
    Eigen::MatrixXd known = problem.prior.covariance;
    for (const Eigen::Index p : problem.free) {
      known.row(p).setZero();
      known.col(p).setZero();
      known(p, p) = open;
    }
    std::vector<Eigen::Index> uncertain;
    for (Eigen::Index p = 0; p < known.rows(); ++p) {
      const bool is_free = std::binary_search(problem.free.begin(), problem.free.end(), p);
      if (is_free || (known(p, p) > 0.0 && information(p, p) > 0.0)) {
        uncertain.push_back(p);
      }
    }
    Eigen::MatrixXd own = information(uncertain, uncertain);
    if (uncertain == problem.free) {
      own.diagonal().array() += 1.0 / open;
      const Eigen::MatrixXd inverse =
          own.llt().solve(Eigen::MatrixXd::Identity(own.rows(), own.cols()));
      covariance_(uncertain, uncertain) = inverse;
      return;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(known(uncertain, uncertain));
    const Eigen::MatrixXd root =
        spectrum.eigenvectors() * spectrum.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
    Eigen::MatrixXd inner = root.transpose() * own * root;
    inner.diagonal().array() += 1.0;
    const Eigen::MatrixXd inverse = root * inner.llt().solve(root.transpose());
    covariance_(uncertain, uncertain) = inverse;
  }

  Eigen::MatrixXd covariance_;
  Eigen::VectorXd gradient_;
};

/// A finding with what belongs to it.
struct Finding {
  std::string name;
  std::string unit;
  std::string advice;
  std::vector<double> scales;
  bool is_step = false;
  Score score = {};
  double probability = 1.0;    ///< of this test alone
  Eigen::VectorXd shift = {};  ///< of the coordinates, were it modelled
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

std::vector<Eigen::Index> steppedColumns(const std::vector<StepCandidate>& steps) {
  std::vector<Eigen::Index> columns;
  for (const StepCandidate& step : steps) {
    for (Eigen::Index k = 0; k < step.count; ++k) {
      columns.push_back(step.first + k);
    }
  }
  return columns;
}

/// All score tests of one estimate.
class Tests {
 public:
  Tests(const EstimationProblem& problem,
        const Estimate& estimate,
        const EstimationOptions& options)
      : problem_(problem),
        estimate_(estimate),
        options_(options),
        columns_(problem),
        steps_(stepCandidates(columns_)),
        sums_(scoreSums(problem, estimate, options, columns_, steppedColumns(steps_))),
        elimination_(problem, estimate, options, sums_),
        streams_(streamsOf(estimate)) {}

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

 private:
  void tryEffects() {
    const std::vector<EffectCandidate> candidates = effectCandidates(columns_);
    const Eigen::Index P = columns_.space().size();
    // Candidates come after the coordinates, but for those whose size is stated.
    const Eigen::Index first = columns_.space().effect();
    const auto count = columns_.size() - first;
    const Eigen::MatrixXd crossed = sums_.information.block(first, 0, count, P);
    const Eigen::MatrixXd spread = crossed * elimination_.covariance();
    Eigen::MatrixXd left = sums_.information.bottomRightCorner(count, count);
    left.noalias() -= spread * crossed.transpose();
    const Eigen::VectorXd gradient = sums_.gradient.tail(count) + crossed * elimination_.step();
    for (const EffectCandidate& candidate : candidates) {
      const auto size = static_cast<Eigen::Index>(candidate.columns.size());
      Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
      Eigen::VectorXd own = Eigen::VectorXd::Zero(size);
      Eigen::VectorXd before = Eigen::VectorXd::Zero(size);
      Eigen::MatrixXd shifts = Eigen::MatrixXd::Zero(P, size);
      for (Eigen::Index a = 0; a < size; ++a) {
        for (const auto& [n, factor] : candidate.columns[static_cast<std::size_t>(a)]) {
          own[a] += factor * gradient[n - first];
          before[a] += factor * factor * sums_.information(n, n);
          shifts.col(a) -= factor * spread.row(n - first).transpose();
          for (Eigen::Index b = 0; b < size; ++b) {
            for (const auto& [m, other] : candidate.columns[static_cast<std::size_t>(b)]) {
              information(a, b) += factor * other * left(n - first, m - first);
            }
          }
        }
      }
      Finding finding{candidate.name, candidate.unit, candidate.advice, candidate.scales};
      finding.score = scoreOf(information, own, before, options_.unobservable_stddev);
      finding.shift = shifts * finding.score.value;
      judge(finding);
      if (finding.score.freedom > 0) {
        findings_.push_back(std::move(finding));
      }
    }
  }

  /// The most significant step of each kind.
  void trySteps() {
    std::vector<Finding> best(steps_.size());
    for (const ScoreSums::Later& later : sums_.later) {
      const Eigen::MatrixXd spread = later.crossed * elimination_.covariance();
      const Eigen::MatrixXd left = later.information - spread * later.crossed.transpose();
      const Eigen::VectorXd gradient = later.gradient + later.crossed * elimination_.step();
      Eigen::Index first = 0;
      for (std::size_t n = 0; n < steps_.size(); ++n) {
        const Eigen::Index count = steps_[n].count;
        Finding finding;
        finding.score = scoreOf(left.block(first, first, count, count),
                                gradient.segment(first, count),
                                later.information.diagonal().segment(first, count),
                                options_.unobservable_stddev);
        judge(finding);
        if (finding.score.freedom > 0 && finding.probability < best[n].probability) {
          finding.name = steps_[n].name + " after sample " + std::to_string(later.after);
          finding.shift = -spread.middleRows(first, count).transpose() * finding.score.value;
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
      finding.probability = chiSquareProbability(finding.score.freedom, square);
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
        mostShift(best.shift),
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
  std::vector<StepCandidate> steps_;
  ScoreSums sums_;
  Elimination elimination_;
  std::array<Stream, 3> streams_;
  std::vector<Finding> findings_;
  std::size_t tests_ = 0;
};

}  // namespace

std::optional<SingleEffect> findSingleEffect(const EstimationProblem& problem,
                                             const Estimate& estimate,
                                             const EstimationOptions& options) {
  return Tests(problem, estimate, options).strongest();
}

}  // namespace sac
