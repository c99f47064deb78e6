#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "wiring_case.hpp"

namespace sac {

/// Degrees of freedom of the Student distribution that misfits of single observations follow: gross
/// errors cost their logarithm only.
inline constexpr double kStudentFreedom = 4.0;

/// −log density of one standardised misfit of squared norm d², without its constant.
double studentLoss(double squared_misfit);

/// Observations that a fit explains.
enum class FittedStream { kOrientations, kTorques, kBoth };

/// Gain in log posterior, with so many continuous values, that a faultless session reaches with a
/// probability of 1e-6 for all hypotheses together: Wilks' theorem and Bonferroni [nats].
double gainByChance(Eigen::Index values);

/// How well one account of the wiring explains one stream, at its most probable parameters.
struct PosteriorFit {
  /// Of noise and parameters, up to a constant that all accounts share [nats].
  double log_posterior = -std::numeric_limits<double>::infinity();
  /// The part of it that the samples tell: without what is known of the parameters beforehand.
  double log_likelihood = -std::numeric_limits<double>::infinity();
  /// Factor ≥ 1 on the expected misfit that explains the observations best: 1 where they are as
  /// stated.
  double scale = std::numeric_limits<double>::infinity();
  Eigen::VectorXd x;       ///< coordinates of the ParameterSpace of the corrected actuator
  Eigen::VectorXd values;  ///< continuous values of the candidate
  /// Of each observation its squared misfit in units of its expected one, without the scale.
  std::vector<double> squared_misfits;
};

/// Whether an explanation bends the unit far beyond its tolerances, or leaves misfits: perhaps it
/// is a part of the right one.
bool isStrained(const PosteriorFit& fit);
/// Whether so many misfits are far off that another mistake may be behind them: half of a session
/// that fits is enough for a fit of heavy tails.
bool leavesMany(const PosteriorFit& fit);

/// What a misfit of the right wiring may have beside the stated noise: no laboratory keeps all of
/// it in mind.
struct ModelAllowance {
  double orientation = 1e-3;  ///< [rad]
  double torque = 0.02;       ///< of large torques that were measured
};

/// Most probable coordinates and values of a candidate: errors of the manufacturing tolerance,
/// Student-distributed misfits of a common scale that is at least 1, by iteratively reweighted
/// Gauss–Newton steps from the nominal actuator (`start` of coordinates where given). `effects` of
/// the laboratory have coordinates beside joints, poles and coils, which may be as large as they
/// like unless their size is stated.
PosteriorFit fitPosterior(const WiringCase& described,
                          const Candidate& candidate,
                          FittedStream stream,
                          const CalibrationConfig& config,
                          const ModelAllowance& allowance,
                          const std::optional<Eigen::VectorXd>& start = std::nullopt,
                          const EffectSelection& effects = {});

/// Covariance of coordinates and, behind them, continuous values at a fit of the same arguments.
Eigen::MatrixXd posteriorCovariance(const WiringCase& described,
                                    const Candidate& candidate,
                                    FittedStream stream,
                                    const CalibrationConfig& config,
                                    const ModelAllowance& allowance,
                                    const EffectSelection& effects,
                                    const PosteriorFit& fit);

}  // namespace sac
