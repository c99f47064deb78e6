#include "estimate_conclusion.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "observability.hpp"
#include "observed_information.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"
#include "spherical_actuator_calibration/estimation/misfit.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"
#include "weighted_observations.hpp"

namespace sac {
namespace {

/// What the active observations tell at the solution: with N the information of the estimated
/// coordinates, that of the prior of held directions included, δx = −N⁻¹ Σ JᵀS⁻¹ (noise + J_held
/// δheld), and noise, prior and held coordinates are independent of each other.
class Conclusion {
 public:
  Conclusion(const Solution& solution, Estimate& estimate)
      : solution_(solution),
        result_(estimate),
        observations_(*solution.observations),
        point_(observations_.evaluator().at(solution.x())),
        chosen_(solution.x().size(), solution.estimated),
        held_(chosen_.others()) {}

  void run() {
    judgeMisfit();
    findCovariance();
    observations_.forgetPass();  // what is listed takes as much
    listResiduals();
    listErrors();
  }

 private:
  void judgeMisfit();
  double priorMisfit() const;
  double statedMisfit() const;
  Eigen::MatrixXd priorInformation() const;
  Eigen::MatrixXd priorCovariance() const;
  void findCovariance();
  void addHeld(const Eigen::MatrixXd& others, const Eigen::MatrixXd& of_held);
  void fillBelief(const Eigen::MatrixXd& own, Eigen::MatrixXd covariance);
  Eigen::Matrix3d residualCovariance(std::size_t observation, const LinearizedObservation& linear);
  Eigen::Matrix3d sharedWithHeld(std::size_t observation,
                                 const LinearizedObservation& linear,
                                 const Eigen::Matrix3d& noise) const;
  void listResiduals();
  double errorAt(const Eigen::VectorXd& x, ErrorMeasure measure) const;
  void listErrors();

  const Solution& solution_;
  Estimate& result_;
  const WeightedObservations& observations_;
  ModelPoint point_;  ///< the model at the solution
  ChosenCoordinates chosen_;
  std::vector<bool> held_;
  double chi_square_ = 0.0;         ///< of the active observations at the solution
  Eigen::MatrixXd inverse_;         ///< F×F: inverse information of the estimated coordinates
  Eigen::MatrixXd own_covariance_;  ///< F×F: theirs, from stated noise and held coordinates
  /// F×F: own_covariance_ less inverse_ and its transpose, for residuals that took part.
  Eigen::MatrixXd less_than_own_;
  Eigen::MatrixXd with_held_;                       ///< F×P: between them and held coordinates
  std::map<std::size_t, Eigen::MatrixXd> weighed_;  ///< see ObservedInformation
  LinearizedObservation linear_;                    ///< of the observation at hand
  WhitenedObservation whitened_;
};

void Conclusion::judgeMisfit() {
  chi_square_ = observations_.chiSquare(solution_.x());
  const double chi_square = chi_square_ + priorMisfit();
  const auto unknowns = static_cast<int>(solution_.estimated.size());
  const auto held_directions = static_cast<int>(solution_.prior.directions.cols());
  result_.stated_misfit = statedMisfit();
  result_.degrees_of_freedom =
      kObservationComponents * static_cast<int>(observations_.activeCount()) -
      (unknowns - held_directions);
  if (result_.degrees_of_freedom == 0) {
    return;
  }
  const double freedom = result_.degrees_of_freedom;
  result_.reduced_chi_square = chi_square / freedom;
  result_.covariance_scale = std::sqrt(misfitVariance(chi_square, freedom));
}

/// Squared misfit of what was known before, which is one more observation.
double Conclusion::priorMisfit() const {
  const LinearPrior& prior = solution_.prior;
  if (prior.directions.cols() == 0) {
    return 0.0;
  }
  const Eigen::VectorXd apart = prior.directions.transpose() * solution_.x() - prior.mean;
  const Eigen::VectorXd weighed = solveSemidefinite(prior.covariance, apart);
  return apart.dot(weighed);
}

double Conclusion::statedMisfit() const {
  const ParameterSpace& space = solution_.problem->model->space();
  const std::vector<Eigen::Index> stated = statedOf(space, solution_.estimated);
  if (stated.empty()) {
    return 0.0;
  }
  const Eigen::VectorXd apart = solution_.x()(stated);
  const double square = apart.dot(statedInformation(space, stated) * apart);
  return std::sqrt(square / static_cast<double>(stated.size()));
}

/// Σ over a and b of J_a M(a, b) J_bᵀ for a symmetric M, where the places of the columns a and b of
/// J are given.
Eigen::Matrix3d between(const Eigen::Matrix3Xd& J,
                        const std::vector<Eigen::Index>& places,
                        const Eigen::MatrixXd& M) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t b = 0; b < places.size(); ++b) {
    const double* const column = M.col(places[b]).data();
    Eigen::Vector3d product = 0.5 * column[places[b]] * J.col(static_cast<Eigen::Index>(b));
    for (std::size_t a = 0; a < b; ++a) {
      product += column[places[a]] * J.col(static_cast<Eigen::Index>(a));
    }
    sum += product * J.col(static_cast<Eigen::Index>(b)).transpose();
  }
  return sum + sum.transpose();
}

/// F×F: what the prior of held directions tells of the estimated coordinates.
Eigen::MatrixXd Conclusion::priorInformation() const {
  const Eigen::MatrixXd directions = solution_.prior.directions(solution_.estimated, Eigen::all);
  return directions * solveSemidefinite(solution_.prior.covariance, directions.transpose());
}

/// F×F: the part of their covariance that is due to that prior.
Eigen::MatrixXd Conclusion::priorCovariance() const {
  const Eigen::MatrixXd spread =
      inverse_ * solution_.prior.directions(solution_.estimated, Eigen::all);
  return spread * solveSemidefinite(solution_.prior.covariance, spread.transpose());
}

void Conclusion::findCovariance() {
  ObservedInformation information = observedInformation(solution_);
  weighed_ = std::move(information.weighed);
  result_.condition_number =
      identifiedConditionNumber(information.data, solution_.options->unobservable_stddev);
  inverse_ = InformationFactor(information.data + priorInformation()).inverse();
  const Eigen::MatrixXd prior_covariance = priorCovariance();
  const Eigen::MatrixXd noise_covariance = information.is_noise_alone
                                               ? (inverse_ - prior_covariance).eval()
                                               : (inverse_ * information.noise * inverse_).eval();
  Eigen::MatrixXd covariance = solution_.problem->prior.covariance;
  for (const Eigen::Index a : solution_.estimated) {
    covariance.row(a).setZero();
    covariance.col(a).setZero();
  }
  own_covariance_ = noise_covariance + prior_covariance;
  addHeld(information.others, covariance);
  const double scale = result_.covariance_scale * result_.covariance_scale;
  own_covariance_ = 0.5 * (own_covariance_ + own_covariance_.transpose()).eval();
  less_than_own_ = own_covariance_ - (inverse_ + inverse_.transpose());
  fillBelief(own_covariance_ + (scale - 1.0) * noise_covariance, std::move(covariance));
}

/// What the uncertainty of held coordinates adds. `others`: F×P, see ObservedInformation;
/// `of_held`: P×P.
void Conclusion::addHeld(const Eigen::MatrixXd& others, const Eigen::MatrixXd& of_held) {
  std::vector<Eigen::Index> uncertain;
  for (Eigen::Index p = 0; p < of_held.rows(); ++p) {
    if (of_held(p, p) > 0.0) {
      uncertain.push_back(p);
    }
  }
  with_held_.setZero(chosen_.size(), of_held.cols());
  if (uncertain.empty()) {
    return;
  }
  // F×U: ∂estimated/∂held.
  const Eigen::MatrixXd gain = -inverse_ * others(Eigen::all, uncertain);
  with_held_ = gain * of_held(uncertain, Eigen::all);
  const Eigen::MatrixXd with_uncertain = std::as_const(with_held_)(Eigen::all, uncertain);
  own_covariance_ += with_uncertain * gain.transpose();
}

/// `own`: of the estimated coordinates; `covariance`: of the held ones, all else zero.
void Conclusion::fillBelief(const Eigen::MatrixXd& own, Eigen::MatrixXd covariance) {
  const std::vector<Eigen::Index>& estimated = solution_.estimated;
  covariance(estimated, Eigen::all) += with_held_;
  covariance(Eigen::all, estimated) += with_held_.transpose();
  covariance(estimated, estimated) = 0.5 * (own + own.transpose());
  result_.belief.x = solution_.x();
  result_.belief.covariance = std::move(covariance);
}

/// Covariance of a residual after the solution: smaller than the observation's own for those that
/// took part in it, larger for those that did not.
Eigen::Matrix3d Conclusion::residualCovariance(std::size_t observation,
                                               const LinearizedObservation& linear) {
  const ObservationEvaluator& evaluator = observations_.evaluator();
  const Eigen::Matrix3d noise = evaluator.noise(observation, linear);
  const Eigen::Matrix3d of_held = evaluator.heldCovariance(linear, held_);
  whiten(linear, Eigen::Matrix3d::Identity(), chosen_, whitened_);
  const WhitenedObservation& own = whitened_;
  Eigen::Matrix3d covariance = noise + of_held;
  if (!of_held.isZero(0.0)) {
    Eigen::Matrix3d crossed = Eigen::Matrix3d::Zero();
    for (const Eigen::Index b : linear.columns) {
      for (std::size_t a = 0; a < own.columns.size(); ++a) {
        crossed += own.jacobian.col(static_cast<Eigen::Index>(a)) * with_held_(own.columns[a], b) *
                   linear.jacobian.col(b).transpose();
      }
    }
    covariance += crossed + crossed.transpose();
  }
  const bool is_active = observations_.active()[observation];
  const bool is_weighed = !of_held.isZero(0.0) || weighed_.count(observation) > 0;
  covariance += between(
      own.jacobian, own.columns, is_active && !is_weighed ? less_than_own_ : own_covariance_);
  if (is_active) {
    if (is_weighed) {
      const Eigen::Matrix3d shared = sharedWithHeld(observation, linear, noise);
      covariance -= shared + shared.transpose();
    }
    // A residual that its own parameters absorb wholly has no variance left: keep a floor.
    constexpr double kFloor = 1e-6;
    covariance += kFloor * noise;
  }
  return covariance;
}

/// Covariance of the noise of an observation with what the solution, which took part of it up, says
/// of its residual.
Eigen::Matrix3d Conclusion::sharedWithHeld(std::size_t observation,
                                           const LinearizedObservation& linear,
                                           const Eigen::Matrix3d& noise) const {
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  const Rows J = linear.jacobian(Eigen::all, solution_.estimated);
  const Eigen::Matrix3d W = observations_.whitening()[observation];
  const Rows weighed = observations_.shared().shares[observation]
                           ? Rows(weighed_.at(observation))
                           : Rows(noise * W.transpose() * W * J);
  return weighed.lazyProduct(inverse_).eval().lazyProduct(J.transpose());
}

void Conclusion::listResiduals() {
  result_.residuals.reserve(observations_.size());
  for (std::size_t n = 0; n < observations_.size(); ++n) {
    observations_.evaluator().linearize(n, point_, linear_);
    ObservationResidual entry;
    entry.observation = solution_.problem->observations[n];
    entry.residual = linear_.residual;
    entry.rejected = !observations_.active()[n];
    const Eigen::Vector3d weighed =
        solveSemidefinite3(residualCovariance(n, linear_), linear_.residual);
    entry.standardized =
        std::sqrt(std::max(0.0, linear_.residual.dot(weighed)) / kObservationComponents);
    result_.residuals.push_back(entry);
  }
}

double Conclusion::errorAt(const Eigen::VectorXd& x, ErrorMeasure measure) const {
  if (measure == ErrorMeasure::kStandardized) {
    const auto values = static_cast<double>(kObservationComponents * observations_.activeCount());
    const double chi_square = x == solution_.x() ? chi_square_ : observations_.chiSquare(x);
    return std::sqrt(chi_square / values);
  }
  const ModelPoint point = observations_.evaluator().at(x);
  double sum = 0.0;
  for (std::size_t n = 0; n < observations_.size(); ++n) {
    if (!observations_.active()[n]) {
      continue;
    }
    const Eigen::Vector3d residual = observations_.evaluator().residual(n, point);
    sum += measure == ErrorMeasure::kOrientation ? residual.norm() : residual.squaredNorm();
  }
  const double mean = sum / static_cast<double>(observations_.activeCount());
  return measure == ErrorMeasure::kOrientation ? mean : std::sqrt(mean);
}

void Conclusion::listErrors() {
  const ErrorMeasure measure = errorMeasure(solution_.problem->observations);
  for (const Eigen::VectorXd& x : solution_.path) {
    result_.error_history.push_back(errorAt(x, measure));
  }
  result_.iterations = static_cast<int>(solution_.path.size()) - 1;
}

}  // namespace

void conclude(const Solution& solution, Estimate& estimate) {
  Conclusion(solution, estimate).run();
}

}  // namespace sac
