#include "pattern_search.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/LU>

namespace sac {
namespace {

/// J as a matrix over all coordinates.
void placeRows(const WhitenedObservation& term, Eigen::Index row, Eigen::MatrixXd& stack) {
  for (std::size_t k = 0; k < term.columns.size(); ++k) {
    stack.block<3, 1>(row, term.columns[k]) = term.jacobian.col(static_cast<Eigen::Index>(k));
  }
}

/// tr((1 + N)⁻¹ Q).
double shrinkage(const Eigen::Matrix3d& innovation, const Eigen::Matrix3d& weighted) {
  const Eigen::Matrix3d sum = Eigen::Matrix3d::Identity() + innovation;
  return (sum.inverse() * weighted).trace();
}

}  // namespace

PatternSearch::PatternSearch(const DesignTask& task,
                             const PoseCandidate& candidate,
                             const Eigen::MatrixXd& covariance,
                             const Eigen::VectorXd& weights)
    : coils_(candidate.terms.size()),
      has_unexcited_(candidate.unexcited.has_value()),
      most_(std::min(task.coils_per_pattern, candidate.terms.size())) {
  const std::size_t count = coils_ + (has_unexcited_ ? 1 : 0);
  const auto rows = static_cast<Eigen::Index>(3 * count);
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(rows, covariance.rows());
  Eigen::MatrixXd effect(covariance.rows(), rows);
  for (std::size_t n = 0; n < count; ++n) {
    const WhitenedObservation& term = n < coils_ ? candidate.terms[n] : *candidate.unexcited;
    const auto row = static_cast<Eigen::Index>(3 * n);
    placeRows(term, row, stack);
    effect.middleCols<3>(row) = term.timesTransposed(covariance);
  }
  innovation_.noalias() = stack * effect;
  const Eigen::MatrixXd mapped = task.reported * effect.topRows(task.reported.cols());
  weighted_.noalias() = mapped.transpose() * (weights.asDiagonal() * mapped);
}

PatternSearch::Settled PatternSearch::none() const {
  Settled settled;
  settled.innovation_row.setZero(3, innovation_.cols());
  settled.weighted_row.setZero(3, weighted_.cols());
  if (has_unexcited_) {
    settle({coils_, 1}, settled);
  }
  return settled;
}

void PatternSearch::settle(const SignedTerm& term, Settled& settled) const {
  const auto at = static_cast<Eigen::Index>(3 * term.term);
  const auto add = [&](const Eigen::MatrixXd& of, Eigen::Matrix3Xd& row, Eigen::Matrix3d& sum) {
    const Eigen::Matrix3d with_settled = row.middleCols<3>(at);
    sum += of.block<3, 3>(at, at) + term.sign * (with_settled + with_settled.transpose());
    row += term.sign * of.middleRows<3>(at);
  };
  add(innovation_, settled.innovation_row, settled.innovation);
  add(weighted_, settled.weighted_row, settled.weighted);
}

double PatternSearch::reduction(const Settled& settled, const SignedTerm& term) const {
  const auto at = static_cast<Eigen::Index>(3 * term.term);
  const auto sum = [&](const Eigen::MatrixXd& of,
                       const Eigen::Matrix3Xd& row,
                       const Eigen::Matrix3d& of_settled) -> Eigen::Matrix3d {
    const Eigen::Matrix3d with_settled = row.middleCols<3>(at);
    return of_settled + of.block<3, 3>(at, at) +
           term.sign * (with_settled + with_settled.transpose());
  };
  return shrinkage(sum(innovation_, settled.innovation_row, settled.innovation),
                   sum(weighted_, settled.weighted_row, settled.weighted));
}

double PatternSearch::reduction(const TermPattern& pattern) const {
  Settled settled = none();
  for (const SignedTerm& term : pattern) {
    settle(term, settled);
  }
  return shrinkage(settled.innovation, settled.weighted);
}

SignedTerm PatternSearch::bestTerm(const Settled& settled,
                                   const TermPattern& pattern,
                                   std::size_t place,
                                   double least) const {
  SignedTerm best_term;
  double best_reduction = -1.0;
  if (place < pattern.size()) {
    best_term = pattern[place];
    best_reduction = least * reduction(settled, best_term);
  }
  for (std::size_t t = 0; t < coils_; ++t) {
    bool is_settled = false;
    for (std::size_t n = 0; n < pattern.size(); ++n) {
      is_settled = is_settled || (n != place && pattern[n].term == t);
    }
    if (is_settled) {
      continue;
    }
    for (const int sign : {1, -1}) {
      const double reduction = this->reduction(settled, {t, sign});
      if (reduction > best_reduction) {
        best_reduction = reduction;
        best_term = {t, sign};
      }
    }
  }
  return best_term;
}

TermPattern PatternSearch::best() const {
  TermPattern pattern;
  Settled settled = none();
  while (pattern.size() < most_) {
    pattern.push_back(bestTerm(settled, pattern, pattern.size(), 1.0));
    settle(pattern.back(), settled);
  }
  return improved(std::move(pattern));
}

TermPattern PatternSearch::improved(TermPattern pattern) const {
  constexpr double kLeastGain = 1.0 + 1e-6;
  constexpr int kMostRounds = 10;
  bool has_changed = true;
  for (int round = 0; has_changed && round < kMostRounds; ++round) {
    has_changed = false;
    for (std::size_t place = 0; place < pattern.size(); ++place) {
      Settled settled = none();
      for (std::size_t n = 0; n < pattern.size(); ++n) {
        if (n != place) {
          settle(pattern[n], settled);
        }
      }
      const SignedTerm changed = bestTerm(settled, pattern, place, kLeastGain);
      has_changed =
          has_changed || changed.term != pattern[place].term || changed.sign != pattern[place].sign;
      pattern[place] = changed;
    }
  }
  return pattern;
}

}  // namespace sac
