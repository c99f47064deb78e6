#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "design_task.hpp"

namespace sac {

/// What patterns at one pose would tell, for a covariance C of the coordinates and of the pose's
/// errors. To measure a torque
/// with the derivative J shrinks the weighted sum of variances by tr((1 + J C Jᵀ)⁻¹ J C W C Jᵀ); J
/// is the sum of the terms of the pattern's coils with their signs, so both products are sums of
/// blocks over pairs of terms.
class PatternSearch {
 public:
  /// `weights`: of the variances of the values for people, which are to shrink.
  PatternSearch(const DesignTask& task,
                const PoseCandidate& candidate,
                const Eigen::MatrixXd& covariance,
                const Eigen::VectorXd& weights);

  /// A pattern that shrinks the weighted sum of variances much: from none on, coils are added that
  /// do so most; then it is improved.
  TermPattern best() const;

  /// The pattern after changes of sign or coil, one at a time, as long as one shrinks the sum more.
  TermPattern improved(TermPattern pattern) const;

  /// By how much the weighted sum of variances shrinks.
  double reduction(const TermPattern& pattern) const;

 private:
  /// Terms that are settled: sums of blocks over their pairs, and with each other term (3×3T).
  struct Settled {
    Eigen::Matrix3d innovation = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d weighted = Eigen::Matrix3d::Zero();
    Eigen::Matrix3Xd innovation_row;
    Eigen::Matrix3Xd weighted_row;
  };

  Settled none() const;
  void settle(const SignedTerm& term, Settled& settled) const;
  /// Of the settled terms and one more.
  double reduction(const Settled& settled, const SignedTerm& term) const;
  /// The term that shrinks the sum most beside those settled, which are all of `pattern` but one at
  /// `place`; the term that is there already where none shrinks it more by a factor of `least`.
  SignedTerm bestTerm(const Settled& settled,
                      const TermPattern& pattern,
                      std::size_t place,
                      double least) const;

  std::size_t coils_;  ///< terms; what is unexcited comes behind them
  bool has_unexcited_;
  std::size_t most_;            ///< coils of a pattern
  Eigen::MatrixXd innovation_;  ///< J C Jᵀ, by pairs of terms
  Eigen::MatrixXd weighted_;    ///< J C W C Jᵀ, likewise
};

}  // namespace sac
