#include "pattern_bound.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "pair_form.hpp"

namespace sac {
namespace {

/// All that a visit may observe: terms of coils, what is unexcited, the orientation.
std::vector<const WhitenedObservation*> observationsOf(const PoseCandidate& candidate) {
  std::vector<const WhitenedObservation*> observations;
  for (const WhitenedObservation& term : candidate.terms) {
    observations.push_back(&term);
  }
  if (candidate.unexcited) {
    observations.push_back(&*candidate.unexcited);
  }
  if (candidate.tracked) {
    observations.push_back(&*candidate.tracked);
  }
  return observations;
}

/// Branch and bound over the coils of a pattern.
class FormMaximum {
 public:
  FormMaximum(const Eigen::MatrixXd& Q, std::size_t coils, std::size_t most, double enough)
      : Q_(Q), most_(std::min(most, coils)), order_(coils) {
    largest_.value = enough;
    std::iota(order_.begin(), order_.end(), 0);
    pull_ = Eigen::VectorXd::Zero(Q.rows());
    double value = 0.0;
    if (Q.rows() > static_cast<Eigen::Index>(coils)) {
      pull_ = Q.rightCols<1>();
      value = Q(Q.rows() - 1, Q.rows() - 1);
    }
    rankTogether();
    std::sort(order_.begin(), order_.end(), [&](Eigen::Index a, Eigen::Index b) {
      return promise(a, most_) > promise(b, most_);
    });
    const double at_root = reachable(0, most_, value);
    descend(0, most_, value);
    if (branches_ > kMostBranches && at_root > largest_.value) {
      largest_ = {at_root, {}};
    }
  }

  const PatternMaximum& largest() const { return largest_; }

 private:
  static constexpr std::size_t kMostBranches = 100'000;

  /// Per coil, sums over the largest |Q_ij| of its row, of 0, 1, 2... of them.
  void rankTogether() {
    for (std::size_t a = 0; a < order_.size(); ++a) {
      std::vector<double> row;
      for (std::size_t b = 0; b < order_.size(); ++b) {
        if (b != a) {
          row.push_back(std::abs(Q_(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b))));
        }
      }
      std::sort(row.begin(), row.end(), std::greater<>());
      std::vector<double> sums(1, 0.0);
      for (const double share : row) {
        sums.push_back(sums.back() + share);
      }
      together_.push_back(std::move(sums));
    }
  }

  /// What coil a adds at most, as one of `open` coils that are to be chosen.
  double promise(Eigen::Index a, std::size_t open) const {
    const std::vector<double>& sums = together_[static_cast<std::size_t>(a)];
    return Q_(a, a) + 2.0 * std::abs(pull_[a]) + sums[std::min(open - 1, sums.size() - 1)];
  }

  /// At most, with `open` coils from order_[next] on.
  double reachable(std::size_t next, std::size_t open, double value) {
    const std::size_t count = std::min(open, order_.size() - next);
    if (count == 0) {
      return value;
    }
    // The largest ones, descending.
    most_promising_.assign(count, -std::numeric_limits<double>::infinity());
    for (std::size_t n = next; n < order_.size(); ++n) {
      double one = promise(order_[n], open);
      for (std::size_t k = count; k-- > 0 && one > most_promising_[k];) {
        if (k + 1 < count) {
          most_promising_[k + 1] = most_promising_[k];
        }
        most_promising_[k] = one;
      }
    }
    return std::accumulate(most_promising_.begin(), most_promising_.end(), value);
  }

  void descend(std::size_t next, std::size_t open, double value) {
    if (open == 0 || next == order_.size()) {
      if (value > largest_.value) {
        largest_ = {value, chosen_};
      }
      return;
    }
    if (++branches_ > kMostBranches || reachable(next, open, value) <= largest_.value) {
      return;
    }
    const Eigen::Index coil = order_[next];
    const double pull = pull_[coil];
    for (const int sign : {pull < 0.0 ? -1 : 1, pull < 0.0 ? 1 : -1}) {
      chosen_.push_back({static_cast<std::size_t>(coil), sign});
      pull_ += sign * Q_.col(coil);
      descend(next + 1, open - 1, value + Q_(coil, coil) + 2.0 * sign * pull);
      pull_ -= sign * Q_.col(coil);
      chosen_.pop_back();
    }
    descend(next + 1, open, value);
  }

  const Eigen::MatrixXd& Q_;
  std::size_t most_;
  PatternMaximum largest_;
  TermPattern chosen_;
  std::vector<Eigen::Index> order_;
  Eigen::VectorXd pull_;  ///< Σ_i s_i Q_ij of those chosen
  std::vector<std::vector<double>> together_;
  std::vector<double> most_promising_;  ///< storage that is reused
  std::size_t branches_ = 0;
};

/// L of a pose's errors for a mixture of the patterns that were found there.
class ErrorElimination {
 public:
  ErrorElimination(const DesignTask& task, const PoseCandidate& candidate, Eigen::MatrixXd L)
      : task_(task), candidate_(candidate), count_(task.known.rows()), L_(std::move(L)) {
    for (const WhitenedObservation& term : candidate.terms) {
      is_needed_ = is_needed_ || (!term.columns.empty() && term.columns.back() >= count_);
    }
    if (L_.size() == 0) {
      L_.setZero(kPoseErrors, count_);
    }
    torques_.setZero(kPoseErrors, count_ + kPoseErrors);
  }

  /// Whether the pose has errors that its measurements share.
  bool isNeeded() const { return is_needed_; }

  const Eigen::MatrixXd& elimination() const { return L_; }

  /// One more pattern of the mixture, of which all have the same share of the torques.
  void take(const TermPattern& pattern) {
    Eigen::Matrix3Xd rows = Eigen::Matrix3Xd::Zero(kPoseErrors, count_ + kPoseErrors);
    addErrorRows(patternObservation(candidate_, pattern), rows);
    ++taken_;
    torques_ += (rows - torques_) / static_cast<double>(taken_);
    rows = static_cast<double>(task_.patterns_per_pose) * torques_;
    if (candidate_.tracked) {
      addErrorRows(*candidate_.tracked, rows);
    }
    const Eigen::Matrix3d own = Eigen::Matrix3d::Identity() + rows.rightCols<kPoseErrors>();
    L_ = own.inverse() * rows.leftCols(count_);
  }

 private:
  /// Adds DᵀJ of all columns.
  void addErrorRows(const WhitenedObservation& observation, Eigen::Matrix3Xd& rows) const {
    for (std::size_t a = 0; a < observation.columns.size(); ++a) {
      const Eigen::Index row = observation.columns[a] - count_;
      for (std::size_t b = 0; row >= 0 && b < observation.columns.size(); ++b) {
        rows(row, observation.columns[b]) +=
            observation.jacobian.col(static_cast<Eigen::Index>(a))
                .dot(observation.jacobian.col(static_cast<Eigen::Index>(b)));
      }
    }
  }

  const DesignTask& task_;
  const PoseCandidate& candidate_;
  Eigen::Index count_;
  bool is_needed_ = false;
  Eigen::MatrixXd L_;
  Eigen::Matrix3Xd torques_;  ///< DᵀJ of one, mean
  std::size_t taken_ = 0;
};

/// Largest sensitivities of one candidate's visits, each with another elimination, by as many of
/// one pattern.
class VisitBound {
 public:
  /// Keeps references to all.
  VisitBound(const DesignTask& task, const PoseCandidate& candidate, const Eigen::MatrixXd& G)
      : task_(task), candidate_(candidate), G_(G), observations_(observationsOf(candidate)) {}

  PatternMaximum at(const Eigen::MatrixXd& L, double enough) {
    Eliminated eliminated;
    eliminated.G_L.resize(G_.rows(), kPoseErrors);
    for (Eigen::Index k = 0; k < kPoseErrors; ++k) {
      eliminated.G_L.col(k).noalias() = G_ * L.row(k).transpose();  // quicker than all at once
    }
    eliminated.L_G_L = L * eliminated.G_L;
    if (!form_) {
      if (reachable(eliminated) <= enough) {
        return {enough, {}};
      }
      form_.emplace(observations_, G_);
    }
    return largest(form_->eliminated(eliminated), eliminated.L_G_L.trace(), enough);
  }

 private:
  /// A bound that is found quickly: two coils together tell at most the mean of their own, as the
  /// form is positive semidefinite.
  double reachable(const Eliminated& eliminated) const {
    double beside = eliminated.L_G_L.trace();
    double root = 0.0;
    std::vector<double> roots;
    for (std::size_t n = 0; n < observations_.size(); ++n) {
      const double own = ownForm(*observations_[n], G_, eliminated);
      if (n < candidate_.terms.size()) {
        roots.push_back(std::sqrt(std::max(0.0, own)));
      } else if (candidate_.tracked && n + 1 == observations_.size()) {
        beside += own;
      } else {
        root = std::sqrt(std::max(0.0, own));
      }
    }
    std::sort(roots.begin(), roots.end(), std::greater<>());
    for (std::size_t n = 0; n < std::min(task_.coils_per_pattern, roots.size()); ++n) {
      root += roots[n];
    }
    return beside + static_cast<double>(task_.patterns_per_pose) * root * root;
  }

  /// `form`: of all observations; `beside`: what counts whatever is excited.
  PatternMaximum largest(const Eigen::MatrixXd& form, double beside, double enough) const {
    if (candidate_.tracked) {
      beside += form(form.rows() - 1, form.cols() - 1);
    }
    const std::size_t coils = candidate_.terms.size();
    if (coils == 0) {
      return {std::max(enough, beside), {}};
    }
    const auto terms = static_cast<Eigen::Index>(coils + (candidate_.unexcited ? 1 : 0));
    const auto torques = static_cast<double>(task_.patterns_per_pose);
    const double enough_of_one = std::max(0.0, (enough - beside) / torques);
    PatternMaximum maximum = largestForm(
        form.topLeftCorner(terms, terms), coils, task_.coils_per_pattern, enough_of_one);
    maximum.value = std::max(enough, beside + torques * maximum.value);
    return maximum;
  }

  const DesignTask& task_;
  const PoseCandidate& candidate_;
  const Eigen::MatrixXd& G_;
  std::vector<const WhitenedObservation*> observations_;
  std::optional<PairForm> form_;
};

}  // namespace

Eigen::MatrixXd sensitivityOf(const DesignTask& task,
                              const Eigen::MatrixXd& covariance,
                              const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd mapped = task.reported * covariance;
  return mapped.transpose() * (weights.asDiagonal() * mapped);
}

PatternMaximum largestForm(const Eigen::MatrixXd& Q,
                           std::size_t coils,
                           std::size_t most,
                           double enough) {
  return FormMaximum(Q, coils, most, enough).largest();
}

VisitMaximum visitSensitivity(const DesignTask& task,
                              const PoseCandidate& candidate,
                              const Eigen::MatrixXd& sensitivity,
                              double enough,
                              Eigen::MatrixXd& elimination) {
  constexpr int kRounds = 4;
  VisitMaximum best;
  ErrorElimination errors(task, candidate, elimination);
  VisitBound bound(task, candidate, sensitivity);
  std::vector<TermPattern> tried;
  const int rounds = errors.isNeeded() ? kRounds : 1;
  for (int round = 0; round < rounds; ++round) {
    const PatternMaximum one = bound.at(errors.elimination(), enough);
    if (round == 0 || one.value < best.value) {
      best.value = one.value;
      elimination = errors.elimination();
    }
    if (one.value <= enough) {
      return {enough, {}};
    }
    if (one.pattern.empty()) {
      break;
    }
    tried.push_back(one.pattern);
    errors.take(one.pattern);
  }
  for (std::size_t n = 0; !tried.empty() && n < task.patterns_per_pose; ++n) {
    best.patterns.push_back(tried[tried.size() - 1 - n % tried.size()]);
  }
  return best;
}

}  // namespace sac
