#pragma once

#include <vector>

#include <Eigen/Core>

#include "score_sum.hpp"
#include "spherical_actuator_calibration/calibration/motion_evidence.hpp"
#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"

namespace sac {

/// What the coordinates of an estimate can make up for: C, the covariance that they have from its
/// observations and from what was known of them. It is never formed.
class CoordinateElimination {
 public:
  /// `beside`: what a motion told of them, which the estimate has counted, too; null: nothing.
  CoordinateElimination(const EstimationProblem& problem,
                        const Estimate& estimate,
                        const EstimationOptions& options,
                        const ScoreSum& sum,
                        const MotionInformation* beside = nullptr);

  /// Y of what columns have in common with the coordinates (P×k), linear in it: YᵀY' = AᵀCA'.
  Eigen::MatrixXd half(const Eigen::MatrixXd& crossed) const {
    return factor_.half(reduced(crossed));
  }
  /// The same of the gradient of all that is known of the coordinates.
  const Eigen::VectorXd& halfGradient() const { return half_gradient_; }
  /// Cc, P.
  Eigen::VectorXd covarianceTimes(const Eigen::VectorXd& crossed) const;

 private:
  /// What observations and stated sizes of effects tell of the coordinates.
  struct Told {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
  };

  CoordinateElimination(const EstimationProblem& problem, const Told& told, double open);

  static Told toldBy(const EstimationProblem& problem,
                     const Estimate& estimate,
                     const ScoreSum& sum,
                     const MotionInformation* beside);
  Eigen::MatrixXd reduced(const Eigen::MatrixXd& crossed) const;
  Eigen::MatrixXd reducedInformation(const Eigen::MatrixXd& information) const;
  Eigen::VectorXd known(double open) const;

  std::vector<Eigen::Index> free_;
  std::vector<Eigen::Index> held_;  ///< uncertain, yet not free
  Eigen::MatrixXd root_;            ///< R with RRᵀ the covariance of the held ones
  InformationFactor factor_;        ///< of the held ones by R, then the free ones
  Eigen::VectorXd half_gradient_;
};

}  // namespace sac
