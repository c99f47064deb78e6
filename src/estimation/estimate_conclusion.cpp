#include "estimate_conclusion.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "chi_square_limit.hpp"
#include "observability.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

constexpr int kComponents = 3;  // of one observation

/// What the active observations tell at the solution: with N the information of the estimated
/// coordinates, that of the prior of held directions included, δx = −N⁻¹ Σ JᵀS⁻¹ (noise + J_held
/// δheld), and noise, prior and held coordinates are independent of each other.
class Conclusion {
 public:
  Conclusion(const Solution& solution, Estimate& estimate)
      : solution_(solution),
        result_(estimate),
        observations_(*solution.observations),
        chosen_(solution.x().size(), solution.estimated),
        held_(chosen_.others()) {}

  void run() {
    judgeMisfit();
    findCovariance();
    listResiduals();
    listErrors();
  }

 private:
  struct Information {
    Eigen::MatrixXd data;   ///< F×F: Σ JᵀS⁻¹J
    Eigen::MatrixXd noise;  ///< F×F: Σ JᵀS⁻¹RS⁻¹J, R the sensor noise alone
    Eigen::MatrixXd others;  ///< F×P: Σ JᵀS⁻¹J_held, zero columns for the estimated coordinates
  };

  void judgeMisfit();
  double priorMisfit() const;
  double statedMisfit() const;
  Information sumInformation();
  void addDwell(const std::vector<std::size_t>& dwell,
                InformationSum& data,
                Eigen::MatrixXd& noise);
  Eigen::MatrixXd priorInformation() const;
  void findCovariance();
  void fillBelief(const Eigen::MatrixXd& own, Eigen::MatrixXd covariance);
  Eigen::Matrix3d residualCovariance(std::size_t observation,
                                     const LinearizedObservation& linear) const;
  void listResiduals();
  double errorAt(const Eigen::VectorXd& x, ErrorMeasure measure) const;
  void listErrors();

  const Solution& solution_;
  Estimate& result_;
  const WeightedObservations& observations_;
  ChosenCoordinates chosen_;
  std::vector<bool> held_;
  Eigen::MatrixXd inverse_;         ///< F×F: inverse information of the estimated coordinates
  Eigen::MatrixXd own_covariance_;  ///< F×F: theirs, from stated noise and held coordinates
  Eigen::MatrixXd with_held_;       ///< F×P: between them and held coordinates
  /// R V⁻¹J, 3×F, of the observations of dwells: R the covariance of the sensors alone.
  std::map<std::size_t, Eigen::MatrixXd> weighed_;
};

void Conclusion::judgeMisfit() {
  constexpr double kSignificance = 1e-3;
  const double chi_square = observations_.chiSquare(solution_.x()) + priorMisfit();
  const auto unknowns = static_cast<int>(solution_.estimated.size());
  const auto held_directions = static_cast<int>(solution_.prior.directions.cols());
  result_.stated_misfit = statedMisfit();
  result_.degrees_of_freedom =
      kComponents * static_cast<int>(observations_.activeCount()) - (unknowns - held_directions);
  if (result_.degrees_of_freedom == 0) {
    return;
  }
  const double freedom = result_.degrees_of_freedom;
  result_.reduced_chi_square = chi_square / freedom;
  if (chi_square > chiSquareLimit(freedom, kSignificance)) {
    result_.covariance_scale = std::sqrt(result_.reduced_chi_square);
  }
}

/// Squared misfit of what was known before, which is one more observation.
double Conclusion::priorMisfit() const {
  const LinearPrior& prior = solution_.prior;
  if (prior.directions.cols() == 0) {
    return 0.0;
  }
  const Eigen::VectorXd apart = prior.directions.transpose() * solution_.x() - prior.mean;
  return apart.dot(prior.covariance.ldlt().solve(apart));
}

double Conclusion::statedMisfit() const {
  const ParameterSpace& space = solution_.problem->model->space();
  double sum = 0.0;
  int count = 0;
  for (const Eigen::Index p : solution_.estimated) {
    const double variance =
        p < space.effect() ? 0.0 : space.effects().statedVariance(p - space.effect());
    if (variance > 0.0) {
      sum += solution_.x()[p] * solution_.x()[p] / variance;
      ++count;
    }
  }
  return count == 0 ? 0.0 : std::sqrt(sum / count);
}

Conclusion::Information Conclusion::sumInformation() {
  const Eigen::Index size = solution_.x().size();
  const ChosenCoordinates every = ChosenCoordinates::all(size);
  InformationSum data(size);
  InformationSum noise(chosen_.size());
  LinearizedObservation linear;
  WhitenedObservation whitened;
  for (std::size_t n = 0; n < observations_.size(); ++n) {
    if (!observations_.active()[n] || observations_.shared().shares[n]) {
      continue;
    }
    observations_.evaluator().linearize(n, solution_.x(), linear);
    const Eigen::Matrix3d& W = observations_.whitening()[n];
    whiten(linear, W, every, whitened);
    data.add(whitened);
    // S⁻¹RS⁻¹ = WᵀLLᵀW with W R Wᵀ = LLᵀ.
    const Eigen::Matrix3d share = W * observations_.evaluator().noise(n, linear) * W.transpose();
    const Eigen::Matrix3d lower = share.llt().matrixL();
    whiten(linear, lower.transpose() * W, chosen_, whitened);
    noise.add(whitened);
  }
  Eigen::MatrixXd noise_of_dwells = Eigen::MatrixXd::Zero(chosen_.size(), chosen_.size());
  for (const std::vector<std::size_t>& dwell : observations_.shared().dwells) {
    addDwell(dwell, data, noise_of_dwells);
  }
  const Eigen::MatrixXd information = data.information();
  Information result;
  result.data = information(solution_.estimated, solution_.estimated);
  result.noise = noise.information() + noise_of_dwells;
  result.others = information(solution_.estimated, Eigen::all);
  result.others(Eigen::all, solution_.estimated).setZero();
  return result;
}

/// With V the covariance of the stacked residuals of a dwell, Y = V⁻¹J has the rows Wᵀ(A − G M⁻¹C)
/// for A = W J, M = I + Σ GᵀG and C = Σ GᵀA, and the shared errors weigh in it as M⁻¹C.
void Conclusion::addDwell(const std::vector<std::size_t>& dwell,
                          InformationSum& data,
                          Eigen::MatrixXd& noise) {
  const Eigen::Index size = solution_.x().size();
  const ChosenCoordinates every = ChosenCoordinates::all(size);
  DwellSum sum(size);
  sum.begin();
  LinearizedObservation linear;
  WhitenedObservation whitened;
  for (const std::size_t n : dwell) {
    if (observations_.active()[n]) {
      observations_.evaluator().linearize(n, solution_.x(), linear);
      whiten(linear, observations_.whitening()[n], every, whitened);
      sum.add(whitened, observations_.shared().loading[n]);
    }
  }
  sum.addTo(data);
  const Eigen::MatrixXd shares =
      (sum.elimination().covariance() * sum.crossed())(Eigen::all, solution_.estimated);
  Eigen::MatrixXd information = shares.transpose() * shares;
  for (const std::size_t n : dwell) {
    if (!observations_.active()[n]) {
      continue;
    }
    const ObservationEvaluator& evaluator = observations_.evaluator();
    evaluator.linearize(n, solution_.x(), linear);
    const Eigen::Matrix3d& W = observations_.whitening()[n];
    const SharedLoading& G = observations_.shared().loading[n];
    Eigen::MatrixXd& weighed = weighed_[n];
    weighed = W.transpose() * (W * linear.jacobian(Eigen::all, solution_.estimated) - G * shares);
    information += weighed.transpose() * evaluator.ownNoise(n) * weighed;
    // Σ over the dwell of cov(e_n, e_m) Y_m.
    weighed = (evaluator.ownNoise(n) * weighed + W.inverse() * G * shares).eval();
  }
  noise += information;
}

/// F×F: what the prior of held directions tells of the estimated coordinates.
Eigen::MatrixXd Conclusion::priorInformation() const {
  const Eigen::MatrixXd directions = solution_.prior.directions(solution_.estimated, Eigen::all);
  return directions * solution_.prior.covariance.ldlt().solve(directions.transpose());
}

void Conclusion::findCovariance() {
  const Information information = sumInformation();
  const Eigen::Index count = chosen_.size();
  result_.condition_number =
      judgeInformation(information.data, solution_.options->unobservable_stddev)
          .identified_condition_number;
  const Eigen::MatrixXd prior_information = priorInformation();
  inverse_ =
      (information.data + prior_information).llt().solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::MatrixXd noise_covariance = inverse_ * information.noise * inverse_;
  const Eigen::MatrixXd prior_covariance = inverse_ * prior_information * inverse_;
  Eigen::MatrixXd covariance = solution_.problem->prior.covariance;
  for (const Eigen::Index a : solution_.estimated) {
    covariance.row(a).setZero();
    covariance.col(a).setZero();
  }
  const Eigen::MatrixXd gain = -inverse_ * information.others;  // F×P: ∂estimated/∂held
  with_held_ = gain * covariance;
  own_covariance_ = noise_covariance + prior_covariance + with_held_ * gain.transpose();
  const double scale = result_.covariance_scale * result_.covariance_scale;
  fillBelief(own_covariance_ + (scale - 1.0) * noise_covariance, std::move(covariance));
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
                                               const LinearizedObservation& linear) const {
  const ObservationEvaluator& evaluator = observations_.evaluator();
  const Eigen::Matrix<double, 3, Eigen::Dynamic> J =
      linear.jacobian(Eigen::all, solution_.estimated);
  Eigen::Matrix<double, Eigen::Dynamic, 3> with_others(J.cols(), 3);
  with_others.setZero();
  for (const Eigen::Index b : linear.columns) {
    with_others += with_held_.col(b) * linear.jacobian.col(b).transpose();
  }
  const Eigen::Matrix3d crossed = J.lazyProduct(with_others);
  Eigen::Matrix3d covariance = evaluator.covariance(observation, linear, held_) + crossed +
                               crossed.transpose() +
                               J.lazyProduct(own_covariance_).eval().lazyProduct(J.transpose());
  if (observations_.active()[observation]) {
    const Eigen::Matrix3d& W = observations_.whitening()[observation];
    const Eigen::Matrix3d noise = evaluator.noise(observation, linear);
    const Eigen::Matrix<double, 3, Eigen::Dynamic> weighed =
        observations_.shared().shares[observation]
            ? Eigen::Matrix<double, 3, Eigen::Dynamic>(weighed_.at(observation))
            : Eigen::Matrix<double, 3, Eigen::Dynamic>(noise * W.transpose() * W * J);
    const Eigen::Matrix3d shared = weighed.lazyProduct(inverse_).eval().lazyProduct(J.transpose());
    covariance -= shared + shared.transpose();
    // A residual that its own parameters absorb wholly has no variance left: keep a floor.
    constexpr double kFloor = 1e-6;
    covariance += kFloor * noise;
  }
  return covariance;
}

void Conclusion::listResiduals() {
  LinearizedObservation linear;
  result_.residuals.reserve(observations_.size());
  for (std::size_t n = 0; n < observations_.size(); ++n) {
    observations_.evaluator().linearize(n, solution_.x(), linear);
    ObservationResidual entry;
    entry.observation = solution_.problem->observations[n];
    entry.residual = linear.residual;
    entry.rejected = !observations_.active()[n];
    const Eigen::LDLT<Eigen::Matrix3d> factor(residualCovariance(n, linear));
    entry.standardized =
        std::sqrt(std::max(0.0, linear.residual.dot(factor.solve(linear.residual))) / kComponents);
    result_.residuals.push_back(entry);
  }
}

double Conclusion::errorAt(const Eigen::VectorXd& x, ErrorMeasure measure) const {
  if (measure == ErrorMeasure::kStandardized) {
    const auto values = static_cast<double>(kComponents * observations_.activeCount());
    return std::sqrt(observations_.chiSquare(x) / values);
  }
  double sum = 0.0;
  for (std::size_t n = 0; n < observations_.size(); ++n) {
    if (!observations_.active()[n]) {
      continue;
    }
    const Eigen::Vector3d residual = observations_.evaluator().residual(n, x);
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
