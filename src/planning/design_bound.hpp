#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "design_task.hpp"

namespace sac {

/// What no design of so many visits can reach.
///
/// For weights w of sum 1 and any positive definite M₀, the largest variance of a design with the
/// information M is at least Σ w_i v_i(M) ≥ φ²/tr(G M), by the inequality of Cauchy and Schwarz;
/// φ = Σ w_i v_i(M₀), G: sensitivityOf() at M₀. tr(G M) in turn is at most tr(G K) for what is
/// known before, and for each visit the largest sensitivity over poses and patterns. So this is a
/// bound whatever w and M₀ are; here M₀ is a mixture of visits that approaches the best one, step
/// by step. It holds over all designs at the candidates, whatever their distances, with the current
/// of each coil anywhere within ± the current, and a sum of all |currents| that a pattern of the
/// task has.
class DesignBound {
 public:
  /// Keeps references. `information`: of a design to begin with, of `visits` poses.
  DesignBound(const DesignTask& task,
              const std::vector<PoseCandidate>& candidates,
              std::size_t visits,
              Eigen::MatrixXd information);

  /// Improves the bound.
  void improve(const std::function<bool()>& is_time_up);

  /// Largest standard deviation of any design at these candidates, at least [rad]; 0 before
  /// improve().
  double stddev() const;

  /// The same where further poses are candidates as well, which lowers it.
  double stddevOver(const std::vector<PoseCandidate>& further) const;

  /// Candidates that tell most to first order, the best first.
  std::vector<std::size_t> promising() const;

 private:
  /// What a bound follows from.
  struct Certificate {
    Eigen::MatrixXd sensitivity;
    double variance = 0.0;              ///< φ
    double of_known = 0.0;              ///< tr(G K)
    double of_visit = 0.0;              ///< the largest of a visit
    double bound(double visits) const;  ///< of the largest variance
  };
  /// A visit and its sensitivity.
  using RankedVisit = std::pair<double, DesignedPose>;

  Certificate certificateHere() const;
  /// Visits to those of the candidates that have the largest sensitivities, at most `most`.
  std::vector<RankedVisit> bestVisits(const Eigen::MatrixXd& sensitivity,
                                      const std::vector<std::size_t>& among,
                                      std::size_t most);
  /// Mixes visits into the design, by the share that makes its norm of variances least.
  void mixIn(const std::vector<RankedVisit>& visits);

  const DesignTask& task_;
  const std::vector<PoseCandidate>& candidates_;
  std::size_t visits_;
  Eigen::MatrixXd information_;
  double exponent_ = 0.0;  ///< of the norm that steps make less
  Certificate best_;
  std::vector<Eigen::MatrixXd> eliminations_;  ///< per candidate, of the errors of its readings
  std::vector<std::size_t> active_;  ///< candidates that steps between looks at all of them see
};

}  // namespace sac
