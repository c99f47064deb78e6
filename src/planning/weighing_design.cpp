#include "weighing_design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "coil_visits.hpp"
#include "pattern_bound.hpp"
#include "pattern_search.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {
namespace {

/// Exponents of the norm of variances, in turn: the first ones lead away from plans that are good
/// for the worst parameter alone.
constexpr double kExponents[] = {8.0, 24.0, 72.0};
constexpr int kMostPassesOfWeighing = 6;
/// Exchanges that gain less, of the logarithm of a standard deviation, are rounding or not worth
/// it.
constexpr double kLeastImprovement = 1e-5;
/// Candidates that are looked at closely where a pose is exchanged.
constexpr std::size_t kPromising = 8;

/// Adds what an observation tells to a covariance (way = 1), or takes it off (way = −1).
void observe(const WhitenedObservation& observation, double way, Eigen::MatrixXd& covariance) {
  const Eigen::Matrix<double, Eigen::Dynamic, 3> effect = observation.timesTransposed(covariance);
  const Eigen::Matrix3d innovation = Eigen::Matrix3d::Identity() + way * observation.times(effect);
  const Eigen::Matrix3d root = Cholesky3(innovation).half(Eigen::Matrix3d::Identity()).transpose();
  const Eigen::Matrix<double, Eigen::Dynamic, 3> gain = effect * root;
  covariance.noalias() -= way * gain * gain.transpose();
}

}  // namespace

WeighingDesign::WeighingDesign(const DesignTask& task,
                               const std::vector<PoseCandidate>& candidates,
                               const std::vector<std::size_t>& poses,
                               std::function<bool()> is_time_up)
    : task_(task),
      candidates_(candidates),
      is_time_up_(std::move(is_time_up)),
      exponent_(kExponents[0]),
      eliminations_(candidates.size()) {
  for (const std::size_t candidate : poses) {
    poses_.push_back({candidate, {}});
  }
}

void WeighingDesign::choosePatterns() {
  // Each pattern is chosen with all poses' orientations known, and those chosen before it.
  for (std::size_t n = 0; n < task_.patterns_per_pose; ++n) {
    for (std::size_t place = 0; place < poses_.size(); ++place) {
      DesignedPose& pose = poses_[place];
      const PoseCandidate& candidate = candidates_[pose.candidate];
      if (candidate.terms.empty()) {
        continue;
      }
      const Eigen::MatrixXd covariance = covarianceAtPose(task_, candidates_, poses_, place);
      pose.patterns.push_back(
          PatternSearch(task_, candidate, covariance, weightsAt(covariance)).best());
    }
  }
  exchangePatterns();
}

void WeighingDesign::exchange() {
  for (const double exponent : kExponents) {
    exponent_ = exponent;
    for (int pass = 0; pass < kMostPassesOfWeighing && !isTimeUp(); ++pass) {
      bool has_changed = false;
      for (int inner = 0; inner < kMostPassesOfWeighing && exchangePatterns(); ++inner) {
        has_changed = true;
      }
      has_changed = exchangePoses() || has_changed;
      if (!has_changed) {
        break;
      }
    }
  }
  for (int pass = 0; pass < kMostPassesOfWeighing && exchangePatterns(); ++pass) {
  }
  spreadCoils();
}

bool WeighingDesign::exchangePatterns() {
  bool has_changed = false;
  for (std::size_t place = 0; place < poses_.size(); ++place) {
    DesignedPose& pose = poses_[place];
    const PoseCandidate& at = candidates_[pose.candidate];
    Eigen::MatrixXd covariance = covarianceAtPose(task_, candidates_, poses_, place);
    for (TermPattern& pattern : pose.patterns) {
      if (isTimeUp()) {
        return has_changed;
      }
      Eigen::MatrixXd without = covariance;
      observe(patternObservation(at, pattern), -1.0, without);
      const PatternSearch search(task_, at, without, weightsAt(without));
      TermPattern changed = search.improved(pattern);
      TermPattern anew = search.best();
      if (search.reduction(anew) > search.reduction(changed)) {
        changed = std::move(anew);
      }
      observe(patternObservation(at, changed), 1.0, without);
      if (meritOf(without) < meritOf(covariance) - kLeastImprovement) {
        pattern = std::move(changed);
        covariance = std::move(without);
        has_changed = true;
      }
    }
  }
  return has_changed;
}

bool WeighingDesign::exchangePoses() {
  bool has_changed = false;
  for (std::size_t n = 0; n < poses_.size() && !isTimeUp(); ++n) {
    double reached = meritOf(covariance());
    // The first one is taken out, what takes its place is the last.
    DesignedPose best_pose = poses_.front();
    poses_.erase(poses_.begin());
    const Eigen::MatrixXd without = covariance();
    for (const std::size_t candidate : promising(without)) {
      Eigen::MatrixXd with = covarianceAtNewPose(without);
      DesignedPose pose = designedAt(candidate, with);
      const double merit = meritOf(with);
      if (merit < reached - kLeastImprovement) {
        reached = merit;
        best_pose = std::move(pose);
        has_changed = true;
      }
    }
    poses_.push_back(std::move(best_pose));
  }
  return has_changed;
}

DesignedPose WeighingDesign::designedAt(std::size_t candidate, Eigen::MatrixXd& covariance) const {
  const PoseCandidate& at = candidates_[candidate];
  DesignedPose pose{candidate, {}};
  if (at.tracked) {
    observe(*at.tracked, 1.0, covariance);
  }
  while (!at.terms.empty() && pose.patterns.size() < task_.patterns_per_pose) {
    pose.patterns.push_back(PatternSearch(task_, at, covariance, weightsAt(covariance)).best());
    observe(patternObservation(at, pose.patterns.back()), 1.0, covariance);
  }
  return pose;
}

void WeighingDesign::spreadCoils() {
  // A coil may lack more than one visit.
  const std::size_t most = kLeastVisits * task_.visited.size();
  std::set<std::size_t> hopeless;
  for (std::size_t tries = 0; tries < most && !isTimeUp(); ++tries) {
    const std::vector<std::size_t> lacking = CoilVisits(task_, candidates_, poses_).lacking();
    const auto next = std::find_if(lacking.begin(), lacking.end(), [&](std::size_t coil) {
      return hopeless.count(coil) == 0;
    });
    if (next == lacking.end()) {
      return;
    }
    if (!exciteElsewhere(*next)) {
      hopeless.insert(*next);
    }
  }
}

bool WeighingDesign::exciteElsewhere(std::size_t coil) {
  const CoilVisits visits(task_, candidates_, poses_);
  double reached = std::numeric_limits<double>::infinity();
  TermPattern best;
  TermPattern* changes = nullptr;
  for (std::size_t place = 0; place < poses_.size(); ++place) {
    const PoseCandidate& at = candidates_[poses_[place].candidate];
    const auto found = std::find(at.coils.begin(), at.coils.end(), coil);
    if (found == at.coils.end() || visits.isExcitedAt(coil, place)) {
      continue;
    }
    const auto term = static_cast<std::size_t>(found - at.coils.begin());
    const Eigen::MatrixXd covariance = covarianceAtPose(task_, candidates_, poses_, place);
    for (TermPattern& pattern : poses_[place].patterns) {
      Eigen::MatrixXd without = covariance;
      observe(patternObservation(at, pattern), -1.0, without);
      for (std::size_t k = 0; k < 2 * pattern.size(); ++k) {
        if (!visits.isSpareAt(at.coils[pattern[k / 2].term], place)) {
          continue;
        }
        TermPattern changed = pattern;
        changed[k / 2] = {term, k % 2 == 0 ? 1 : -1};
        Eigen::MatrixXd with = without;
        observe(patternObservation(at, changed), 1.0, with);
        const double merit = meritOf(with);
        if (merit < reached) {
          reached = merit;
          best = std::move(changed);
          changes = &pattern;
        }
      }
    }
  }
  if (changes == nullptr) {
    return false;
  }
  *changes = std::move(best);
  return true;
}

std::vector<std::size_t> WeighingDesign::promising(const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd sensitivity = sensitivityOf(task_, covariance, weightsAt(covariance));
  // The best ones so far, by falling value.
  std::vector<std::pair<double, std::size_t>> best;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (!keepsDistance(c)) {
      continue;
    }
    const double enough = best.size() < kPromising ? 0.0 : best.back().first;
    const double value =
        visitSensitivity(task_, candidates_[c], sensitivity, enough, eliminations_[c]).value;
    if (best.size() == kPromising && value <= enough) {
      continue;
    }
    const auto place = std::find_if(
        best.begin(), best.end(), [&](const auto& other) { return other.first < value; });
    best.emplace(place, value, c);
    best.resize(std::min(best.size(), kPromising));
  }
  std::vector<std::size_t> result;
  result.reserve(best.size());
  for (const auto& [value, candidate] : best) {
    result.push_back(candidate);
  }
  return result;
}

bool WeighingDesign::keepsDistance(std::size_t candidate) const {
  return std::all_of(poses_.begin(), poses_.end(), [&](const DesignedPose& pose) {
    return pose.candidate != candidate &&
           areApart(candidates_[pose.candidate], candidates_[candidate], task_.minimum_spacing);
  });
}

Eigen::MatrixXd WeighingDesign::covariance() const {
  return covarianceOf(designInformation(task_, candidates_, poses_));
}

Eigen::VectorXd WeighingDesign::weightsAt(const Eigen::MatrixXd& covariance) const {
  return steepWeights(reportedVariances(task_, covariance), exponent_);
}

double WeighingDesign::meritOf(const Eigen::MatrixXd& covariance) const {
  return 0.5 * std::log(steepNorm(reportedVariances(task_, covariance), exponent_));
}

double WeighingDesign::worstStddev() const {
  return std::sqrt(reportedVariances(task_, covariance()).maxCoeff());
}

}  // namespace sac
