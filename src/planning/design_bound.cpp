#include "design_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pattern_bound.hpp"

namespace sac {
namespace {

/// Exponents of the norm of variances that stands for the largest one, from the first look to the
/// last: a low one approaches quickly, a high one ends nearer to the largest.
constexpr double kFirstExponent = 30.0;
constexpr double kLastExponent = 66.0;
/// Steps see the most promising candidates; all of them are looked at between, each time for a new
/// bound. Further looks, at the last exponent, follow until the bound is so near to the mixture:
/// where orientations tell as much as torques, it approaches slowly.
constexpr std::size_t kLooks = 8;
constexpr std::size_t kMostLooks = 24;
constexpr double kNearMixture = 0.97;
constexpr std::size_t kStepsPerLook = 8;
constexpr std::size_t kActive = 200;
/// Visits that one step mixes in, at different poses: a single one would rarely be worth a step.
constexpr std::size_t kTogether = 10;

double normAt(const DesignTask& task, const Eigen::MatrixXd& information, double exponent) {
  return steepNorm(reportedVariances(task, covarianceOf(information)), exponent);
}

/// The share of `other` in a mixture of two designs that makes the norm least, by golden section.
double bestShare(const DesignTask& task,
                 const Eigen::MatrixXd& information,
                 const Eigen::MatrixXd& other,
                 double exponent) {
  constexpr double kMostShare = 0.5;
  constexpr double kSection = 0.382;
  constexpr int kSections = 10;
  const auto norm = [&](double share) {
    return normAt(task, (1.0 - share) * information + share * other, exponent);
  };
  double low = 0.0;
  double high = kMostShare;
  double a = low + kSection * (high - low);
  double b = high - kSection * (high - low);
  double at_a = norm(a);
  double at_b = norm(b);
  for (int n = 0; n < kSections; ++n) {
    if (at_a < at_b) {
      high = std::exchange(b, a);
      at_b = at_a;
      a = low + kSection * (high - low);
      at_a = norm(a);
    } else {
      low = std::exchange(a, b);
      at_a = at_b;
      b = high - kSection * (high - low);
      at_b = norm(b);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

DesignBound::DesignBound(const DesignTask& task,
                         const std::vector<PoseCandidate>& candidates,
                         std::size_t visits,
                         Eigen::MatrixXd information)
    : task_(task),
      candidates_(candidates),
      visits_(visits),
      information_(std::move(information)),
      eliminations_(candidates.size()) {}

double DesignBound::Certificate::bound(double visits) const {
  return variance * variance / (of_known + visits * of_visit);
}

void DesignBound::improve(const std::function<bool()>& is_time_up) {
  std::vector<std::size_t> all(candidates_.size());
  std::iota(all.begin(), all.end(), 0);
  const auto visits = static_cast<double>(visits_);
  for (std::size_t look = 0; look < kMostLooks; ++look) {
    const double way = static_cast<double>(look) / static_cast<double>(kLooks - 1);
    exponent_ = kFirstExponent + (kLastExponent - kFirstExponent) * std::min(1.0, way);
    for (std::size_t step = 0; look > 0 && step < kStepsPerLook; ++step) {
      mixIn(bestVisits(certificateHere().sensitivity, active_, kTogether));
    }
    if (is_time_up && is_time_up()) {
      return;
    }
    Certificate here = certificateHere();
    const std::vector<RankedVisit> best = bestVisits(here.sensitivity, all, kActive);
    here.of_visit = best.front().first;
    const double mixture = std::sqrt(here.variance);
    if (best_.variance == 0.0 || here.bound(visits) > best_.bound(visits)) {
      best_ = std::move(here);
    }
    active_.clear();
    for (const RankedVisit& visit : best) {
      active_.push_back(visit.second.candidate);
    }
    if (look + 1 >= kLooks && stddev() > kNearMixture * mixture) {
      return;
    }
  }
}

DesignBound::Certificate DesignBound::certificateHere() const {
  const Eigen::MatrixXd covariance = covarianceOf(information_);
  const Eigen::VectorXd variances = reportedVariances(task_, covariance);
  const Eigen::VectorXd weights = steepWeights(variances, exponent_);
  Certificate here;
  here.sensitivity = sensitivityOf(task_, covariance, weights);
  here.variance = weights.dot(variances);
  here.of_known = here.sensitivity.cwiseProduct(task_.known).sum();
  return here;
}

std::vector<DesignBound::RankedVisit> DesignBound::bestVisits(const Eigen::MatrixXd& sensitivity,
                                                              const std::vector<std::size_t>& among,
                                                              std::size_t most) {
  std::vector<RankedVisit> best;
  for (const std::size_t c : among) {
    const double enough = best.size() < most ? 0.0 : best.back().first;
    VisitMaximum maximum =
        visitSensitivity(task_, candidates_[c], sensitivity, enough, eliminations_[c]);
    if (maximum.value <= enough && best.size() == most) {
      continue;
    }
    RankedVisit visit(maximum.value, DesignedPose{c, std::move(maximum.patterns)});
    const auto place = std::upper_bound(
        best.begin(), best.end(), visit, [](const RankedVisit& a, const RankedVisit& b) {
          return a.first > b.first;
        });
    best.insert(place, std::move(visit));
    if (best.size() > most) {
      best.pop_back();
    }
  }
  return best;
}

void DesignBound::mixIn(const std::vector<RankedVisit>& visits) {
  std::vector<DesignedPose> poses;
  poses.reserve(visits.size());
  for (const RankedVisit& visit : visits) {
    poses.push_back(visit.second);
  }
  const double share_of_one = static_cast<double>(visits_) / static_cast<double>(poses.size());
  const Eigen::MatrixXd other =
      task_.known + share_of_one * (designInformation(task_, candidates_, poses) - task_.known);
  const double share = bestShare(task_, information_, other, exponent_);
  information_ = (1.0 - share) * information_ + share * other;
}

double DesignBound::stddev() const {
  return best_.variance > 0.0 ? std::sqrt(best_.bound(static_cast<double>(visits_))) : 0.0;
}

double DesignBound::stddevOver(const std::vector<PoseCandidate>& further) const {
  Certificate certificate = best_;
  for (const PoseCandidate& candidate : further) {
    Eigen::MatrixXd elimination;
    certificate.of_visit =
        visitSensitivity(task_, candidate, best_.sensitivity, certificate.of_visit, elimination)
            .value;
  }
  return std::sqrt(certificate.bound(static_cast<double>(visits_)));
}

std::vector<std::size_t> DesignBound::promising() const {
  return active_;
}

}  // namespace sac
