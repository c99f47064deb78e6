#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "evidence.hpp"
#include "levitated_screen.hpp"
#include "moved_hypotheses.hpp"
#include "orientation_hypotheses.hpp"
#include "posterior_fit.hpp"
#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "strength_screen.hpp"
#include "torque_screen.hpp"
#include "torque_sensor_screen.hpp"
#include "wiring_case.hpp"

namespace sac {
namespace {

/// Logarithm of the odds against one mistake, before any sample: one laboratory in a thousand.
constexpr double kMistakeCost = 6.907755278982137;
/// Odds below it do not tell two hypotheses apart: about 50 to 1 [nats].
constexpr double kTieOfMistakes = 4.0;
constexpr int kMostRounds = 6;
/// So much is gained by a better optimum as well [nats].
constexpr double kDoubtful = 100.0;

/// A candidate after its fit.
struct Judged {
  Candidate parts;
  PosteriorFit fit;
  double gain = 0.0;  ///< [nats]

  double score() const { return gain - kMistakeCost * static_cast<double>(parts.size()); }
  /// Among hypotheses of which one contains the other, the simpler one unless odds say otherwise,
  /// and it leaves more than a tenth unexplained: what is right may still be slightly off.
  double scoreInFamily() const {
    constexpr double kUnexplained = 0.1;
    const auto values = static_cast<double>(fit.values.size());
    return score() - kMistakeCost * values - (values > 0.0 ? kUnexplained * gain : 0.0);
  }
};

bool isMaterial(const Judged& judged) {
  Eigen::Index at = 0;
  for (const Hypothesis& part : judged.parts) {
    const Eigen::VectorXd own = judged.fit.values.segment(at, part.start.size());
    at += part.start.size();
    if (part.is_material && !part.is_material(own)) {
      return false;
    }
  }
  return true;
}

/// Looks for mistakes in one stream after the other.
class Diagnostician {
 public:
  Diagnostician(const Actuator& nominal,
                const std::vector<Sample>& samples,
                const CalibrationConfig& config)
      : config_(config), case_{nominal, samples} {
    result_.redescribed = nominal;
    const Evidence evidence = evidenceOf(nominal, samples);
    orientations_ = evidence.orientations;
    torques_ = evidence.torques;
  }

  WiringDiagnosis run() {
    const bool has_orientations = orientations_ >= kFewestOrientations;
    if (has_orientations) {
      diagnoseOrientations();
    }
    // Where joints or tracker are wrong in a way that nobody knows, torques blame coils for it.
    if (torques_ >= kFewestTorques && are_orientations_explained_) {
      diagnoseTorques(!has_orientations);
    }
    result_.actuator = case_.actuator;
    result_.samples = case_.samples;
    redescribe();
    return std::move(result_);
  }

 private:
  struct Redescription {
    std::function<void(Actuator&, const Eigen::VectorXd& values)> change;
    Eigen::VectorXd values;
  };

  void diagnoseOrientations() {
    for (int round = 0; round < kMostRounds; ++round) {
      const PosteriorFit base = fitted({}, FittedStream::kOrientations);
      std::vector<Judged> candidates =
          judged(screenOrientations(case_, config_), base, FittedStream::kOrientations, false);
      std::vector<Judged> found = decided(candidates);
      for (int further = 0; further < 2 && isLeftOpen(found, base); ++further) {
        for (Judged& one : judged(further == 0 ? screenOrientationPairs(case_, config_)
                                               : screenMovesAndReadings(base),
                                  base,
                                  FittedStream::kOrientations,
                                  false)) {
          candidates.push_back(std::move(one));
        }
        found = decided(candidates);
      }
      if (found.empty()) {
        are_orientations_explained_ = base.scale <= mostMisfit();
        return;
      }
      take(judgedByTorques(std::move(found)));
    }
  }

  bool isLeftOpen(const std::vector<Judged>& found, const PosteriorFit& base) const {
    if (found.empty()) {
      return base.scale > mostMisfit() || leavesMany(base);
    }
    return isStrained(found.front().fit) || leavesMany(found.front().fit);
  }

  /// Moves at the joints as described, at those that fit most, and at those of the best account of
  /// both: a small one is lost in their tolerance, and a large one leaves none to fit.
  std::vector<ScreenedCandidate> screenMovesAndReadings(const PosteriorFit& base) const {
    std::vector<ScreenedCandidate> all =
        screenMoved(case_, Eigen::VectorXd::Zero(base.x.size()), config_);
    PosteriorFit best = base;
    for (int round = 0; round < 2; ++round) {
      std::vector<ScreenedCandidate> some = screenMoved(case_, best.x, config_);
      std::move(some.begin(), some.end(), std::back_inserter(all));
      for (std::size_t n = 0; round == 0 && n < all.size(); ++n) {
        const PosteriorFit fit = fitted(all[n].parts, FittedStream::kOrientations);
        best = fit.log_posterior > best.log_posterior ? fit : best;
      }
    }
    std::vector<ScreenedCandidate> readings = screenReadings(case_, config_);
    std::move(readings.begin(), readings.end(), std::back_inserter(all));
    return all;
  }

  void diagnoseTorques(bool with_joints) {
    PosteriorFit base = fitted({}, FittedStream::kTorques);
    const std::optional<std::string> stuck =
        isStrained(base) ? stuckTorques(case_.samples) : std::nullopt;
    if (stuck) {
      constexpr double kToTheLastDigit = 10.0;  // nats of each repeated torque, and more
      result_.mistakes.push_back(
          {"torque_stuck", *stuck, kToTheLastDigit * static_cast<double>(torques_)});
      result_.beyond_description.emplace_back("torque_stuck");
      return;
    }
    const WiringCase before = case_;
    const WiringDiagnosis result_before = result_;
    const std::vector<Redescription> redescriptions_before = redescriptions_;
    for (int round = 0; round < kMostRounds; ++round) {
      const std::vector<Judged> found =
          decided(judged(screenedTorques(base, with_joints), base, FittedStream::kTorques, true));
      if (found.empty()) {
        break;
      }
      take(found);
      base = found.front().fit;
    }
    // What does not explain the torques in the end may be anything else.
    if (base.scale > mostMisfit()) {
      case_ = before;
      result_ = result_before;
      redescriptions_ = redescriptions_before;
    }
  }

  /// By the misfit of the torques as described, and beside it at the parameters that explain them
  /// best so far: there a single coil or pole shows that is lost in the tolerance of all.
  std::vector<ScreenedCandidate> screenedTorques(const PosteriorFit& base, bool with_joints) const {
    std::vector<ScreenedCandidate> all = screenTorques(case_, config_, with_joints);
    const WiringCase fitted{ParameterSpace(case_.actuator).actuatorAt(base.x), case_.samples};
    addUnknown(screenMisfittingCoils(case_, fitted, config_), all);
    addUnknown(screenStrengths(case_, base, config_), all);
    addUnknown(screenTorqueSensor(case_, config_), all);
    if (isStrained(base) && !case_.actuator.has_joints) {
      addUnknown(screenTrackerByTorques(case_, config_), all);
    }
    addUnknown(simplerOnes(all), all);
    return all;
  }

  static void addUnknown(std::vector<ScreenedCandidate> further,
                         std::vector<ScreenedCandidate>& all) {
    for (ScreenedCandidate& candidate : further) {
      const bool is_known = std::any_of(all.begin(), all.end(), [&](const ScreenedCandidate& one) {
        return causes(one.parts) == causes(candidate.parts);
      });
      if (!is_known) {
        all.push_back(std::move(candidate));
      }
    }
  }

  double mostMisfit() const { return std::sqrt(config_.estimation.max_reduced_chi_square); }

  PosteriorFit fitted(const Candidate& candidate, FittedStream stream) const {
    return fitPosterior(case_, candidate, stream, config_, ModelAllowance{});
  }

  /// Those that gain more than chance would, and that explain their stream unless later rounds may.
  std::vector<Judged> judged(const std::vector<ScreenedCandidate>& candidates,
                             const PosteriorFit& base,
                             FittedStream stream,
                             bool later_rounds_explain) const {
    std::vector<Judged> all;
    for (const ScreenedCandidate& candidate : candidates) {
      Judged one;
      one.parts = candidate.parts;
      one.fit = fitted(candidate.parts, stream);
      const double by_chance =
          gainByChance(one.fit.values.size()) * static_cast<double>(one.parts.size());
      one.gain = one.fit.log_posterior - base.log_posterior;
      for (const Hypothesis& part : one.parts) {
        one.gain -= part.cost;
      }
      if (one.gain > by_chance && one.gain < kDoubtful) {
        // Perhaps what was described had found another optimum only.
        const PosteriorFit again =
            fitPosterior(case_, {}, stream, config_, ModelAllowance{}, one.fit.x);
        one.gain -= std::max(0.0, again.log_posterior - base.log_posterior);
      }
      if (one.gain > by_chance && (later_rounds_explain || one.fit.scale < mostMisfit()) &&
          isMaterial(one) && isSure(one)) {
        all.push_back(std::move(one));
      }
    }
    return all;
  }

  /// The best, and those that explain as much.
  static std::vector<Judged> decided(std::vector<Judged> candidates) {
    std::stable_sort(candidates.begin(), candidates.end(), [](const Judged& a, const Judged& b) {
      return a.scoreInFamily() > b.scoreInFamily();
    });
    std::vector<Judged> best_of_family;
    for (Judged& candidate : candidates) {
      const bool is_known =
          std::any_of(best_of_family.begin(), best_of_family.end(), [&](const Judged& other) {
            return family(other.parts) == family(candidate.parts);
          });
      if (!is_known) {
        best_of_family.push_back(std::move(candidate));
      }
    }
    const auto best = std::max_element(
        best_of_family.begin(), best_of_family.end(), [](const Judged& x, const Judged& y) {
          return x.score() < y.score();
        });
    if (best == best_of_family.end()) {
      return best_of_family;
    }
    // Continuous values that others lack take up errors of the tolerance as well.
    const double needed = best->score() - kTieOfMistakes;
    const Eigen::Index values = best->fit.values.size();
    best_of_family.erase(
        std::remove_if(best_of_family.begin(),
                       best_of_family.end(),
                       [needed, values](const Judged& candidate) {
                         const auto fewer = static_cast<double>(
                             std::max<Eigen::Index>(0, values - candidate.fit.values.size()));
                         return candidate.score() < needed - kTieOfMistakes * fewer;
                       }),
        best_of_family.end());
    return best_of_family;
  }

  /// Torques can tell a joint sensor from the tracker where orientations cannot.
  std::vector<Judged> judgedByTorques(std::vector<Judged> found) const {
    if (found.size() < 2 || torques_ < kFewestTorques) {
      return found;
    }
    std::vector<double> scores;
    for (const Judged& candidate : found) {
      const WiringCase mended = corrected(case_, candidate.parts, candidate.fit.values);
      scores.push_back(fitPosterior(mended, {}, FittedStream::kTorques, config_, ModelAllowance{})
                           .log_posterior);
    }
    const double best = *std::max_element(scores.begin(), scores.end());
    std::vector<Judged> left;
    for (std::size_t n = 0; n < found.size(); ++n) {
      if (scores[n] > best - gainByChance(0)) {
        left.push_back(std::move(found[n]));
      }
    }
    return left;
  }

  /// Names what was found and goes on without the first of it.
  void take(const std::vector<Judged>& found) {
    for (const Judged& candidate : found) {
      std::string others;
      for (const Judged& other : found) {
        if (&other != &candidate) {
          others += (others.empty() ? "" : ", ") + causes(other.parts);
        }
      }
      name(candidate, others);
    }
    const Judged& first = found.front();
    case_ = corrected(case_, first.parts, first.fit.values);
    Eigen::Index at = 0;
    for (const Hypothesis& part : first.parts) {
      if (part.redescribe) {
        redescriptions_.push_back(
            {part.redescribe, first.fit.values.segment(at, part.start.size())});
      } else {
        result_.beyond_description.push_back(part.cause);
      }
      at += part.start.size();
    }
  }

  /// Corrections of what was measured come one after the other; in the description the last one is
  /// next to the unit: of readings that are turned around and then shifted, the shift comes first.
  void redescribe() {
    for (auto one = redescriptions_.rbegin(); one != redescriptions_.rend(); ++one) {
      one->change(result_.redescribed, one->values);
    }
  }

  void name(const Judged& candidate, const std::string& others) {
    Eigen::Index at = 0;
    for (const Hypothesis& part : candidate.parts) {
      const Eigen::VectorXd own = candidate.fit.values.segment(at, part.start.size());
      at += part.start.size();
      std::string message = part.sentence(own);
      message.front() = static_cast<char>(std::toupper(message.front()));
      if (part.is_strength) {
        message += strengthInWords(candidate, at - 1);
      }
      if (!others.empty()) {
        message += " The samples are explained as well by " + others + ".";
      }
      result_.mistakes.push_back({part.cause, message, candidate.gain});
    }
  }

  /// Whether a strength is other than 1 beyond what the samples leave open.
  bool isSure(const Judged& candidate) const {
    return candidate.parts.size() != 1 || !candidate.parts.front().is_strength ||
           std::abs(candidate.fit.values[0] - 1.0) > kSignificant * valueStddev(candidate, 0);
  }

  /// `value`: its place among the continuous values of the candidate.
  double valueStddev(const Judged& candidate, Eigen::Index value) const {
    const Eigen::Index place = candidate.fit.x.size() + value;
    const Eigen::MatrixXd covariance = posteriorCovariance(case_,
                                                           candidate.parts,
                                                           FittedStream::kTorques,
                                                           config_,
                                                           ModelAllowance{},
                                                           {},
                                                           candidate.fit);
    return std::sqrt(covariance(place, place));
  }

  std::string strengthInWords(const Judged& candidate, Eigen::Index value) const {
    return format(
        " Strength: %.4g ± %.2g.", candidate.fit.values[value], valueStddev(candidate, value));
  }

  const CalibrationConfig& config_;
  WiringCase case_;
  WiringDiagnosis result_;
  std::vector<Redescription> redescriptions_;
  std::size_t orientations_ = 0;
  std::size_t torques_ = 0;
  bool are_orientations_explained_ = true;
};

}  // namespace

WiringDiagnosis diagnoseWiring(const Actuator& nominal,
                               const std::vector<Sample>& samples,
                               const CalibrationConfig& config) {
  return Diagnostician(nominal, samples, config).run();
}

}  // namespace sac
