#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/Cholesky>

#include <boost/math/distributions/chi_squared.hpp>

#include "normal_equations.hpp"
#include "observability.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/estimation/least_squares.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/unidentified_part.hpp"

namespace sac {
namespace {

constexpr int kComponents = 3;  // of one observation

/// Squared norm that a 3-component residual exceeds with the given probability.
double chiSquareLimit(double degrees_of_freedom, double probability) {
  const boost::math::chi_squared_distribution<double> distribution(degrees_of_freedom);
  return boost::math::quantile(boost::math::complement(distribution, probability));
}

void checkProblem(const EstimationProblem& problem) {
  const ParameterSpace& space = problem.model->space();
  const Eigen::Index size = space.size();
  if (problem.prior.x.size() != size || problem.prior.covariance.rows() != size ||
      problem.prior.covariance.cols() != size) {
    throw DataError("The prior does not have one entry for each of the " + std::to_string(size) +
                    " parameters.");
  }
  for (const Eigen::Index parameter : problem.free) {
    if (parameter < 0 || parameter >= size) {
      throw DataError("Parameter " + std::to_string(parameter) + " does not exist.");
    }
  }
  for (const Observation& observation : problem.observations) {
    if (observation.sample >= problem.samples->size()) {
      throw DataError("Sample " + std::to_string(observation.sample) + " does not exist.");
    }
    if (observation.quantity == Quantity::kTorque && !problem.model->hasTorqueModel()) {
      throw DataError(
          "Torque samples need poles, coils and a torque curve in the actuator description.");
    }
    validate((*problem.samples)[observation.sample], space.coils());
  }
}

/// The steps of one estimation. Invariant: whitening_ belongs to the last call of updateWeights().
class Estimator {
 public:
  Estimator(const EstimationProblem& problem, const EstimationOptions& options)
      : problem_(problem),
        options_(options),
        evaluator_(problem, options),
        whitening_(problem.observations.size()),
        active_(problem.observations.size(), true),
        free_(static_cast<std::size_t>(problem.model->space().size()), false) {}

  Estimate run();

 private:
  void setFree(const UnidentifiedPart& part);
  bool updateWeights(const Eigen::VectorXd& x);
  NormalEquations normalEquations(const Eigen::VectorXd& x,
                                  const std::vector<Eigen::Index>& coordinates) const;
  UnidentifiedPart unidentifiedAt(const Eigen::VectorXd& x) const;
  Eigen::MatrixXd priorInformation() const;
  LeastSquaresResult solve(const Eigen::VectorXd& start, Loss loss, double transition);
  std::vector<double> whitenedSquares(const Eigen::VectorXd& x) const;
  bool solveWithoutOutliers();
  bool solveReweighted();
  double outlierLimit() const;
  bool rejectOutliers();
  void concludeCovariance();
  void concludeResiduals();
  void concludeErrorHistory();
  void concludeChiSquare();
  Eigen::Matrix3d residualCovariance(std::size_t observation,
                                     const LinearizedObservation& linear,
                                     const std::vector<bool>& held) const;
  std::size_t activeCount() const {
    return static_cast<std::size_t>(std::count(active_.begin(), active_.end(), true));
  }
  bool hasEnoughObservations() const {
    return static_cast<std::size_t>(kComponents) * activeCount() >= estimated_.size();
  }
  std::vector<bool> heldCoordinates() const {
    std::vector<bool> held = free_;
    held.flip();
    return held;
  }

  const EstimationProblem& problem_;
  const EstimationOptions& options_;
  ObservationEvaluator evaluator_;
  std::vector<Eigen::Matrix3d> whitening_;
  std::vector<bool> active_;
  std::vector<bool> free_;
  std::vector<Eigen::Index> estimated_;
  LinearPrior prior_;               ///< of the directions that are held
  Eigen::MatrixXd inverse_;         ///< F×F: inverse information of estimated_
  Eigen::MatrixXd own_covariance_;  ///< F×F: of estimated_, from stated noise and held coordinates
  Eigen::MatrixXd with_held_;       ///< F×P: between estimated_ and held coordinates
  Eigen::VectorXd x_;
  std::vector<Eigen::VectorXd> path_;
  Estimate result_;
};

/// Chooses the coordinates to estimate, the free ones of the problem without those held whole, and
/// the prior of the directions that are held.
void Estimator::setFree(const UnidentifiedPart& part) {
  const std::vector<Eigen::Index>& weak = part.coordinates;
  estimated_.clear();
  std::set_difference(problem_.free.begin(),
                      problem_.free.end(),
                      weak.begin(),
                      weak.end(),
                      std::back_inserter(estimated_));
  std::fill(free_.begin(), free_.end(), false);
  for (const Eigen::Index parameter : estimated_) {
    free_[static_cast<std::size_t>(parameter)] = true;
  }
  prior_.directions = part.directions;
  prior_.mean = part.directions.transpose() * problem_.prior.x;
  prior_.covariance = part.directions.transpose() * problem_.prior.covariance * part.directions;
}

/// Recomputes whitening_ at x. Returns whether it changed noticeably.
bool Estimator::updateWeights(const Eigen::VectorXd& x) {
  constexpr double kNoticeable = 1e-6;
  const std::vector<bool> held = heldCoordinates();
  bool changed = false;
  LinearizedObservation linear;
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    evaluator_.linearize(n, x, linear);
    const Eigen::Matrix3d total = evaluator_.covariance(n, linear, held);
    const Eigen::Matrix3d lower = total.llt().matrixL();
    const Eigen::Matrix3d whitening =
        lower.triangularView<Eigen::Lower>().solve(Eigen::Matrix3d::Identity());
    changed = changed || !whitening.isApprox(whitening_[n], kNoticeable);
    whitening_[n] = whitening;
  }
  return changed;
}

NormalEquations Estimator::normalEquations(const Eigen::VectorXd& x,
                                           const std::vector<Eigen::Index>& coordinates) const {
  return accumulateNormalEquations({&evaluator_, &whitening_, active_}, x, coordinates);
}

/// What the active observations leave open of the free coordinates of the problem, at x.
UnidentifiedPart Estimator::unidentifiedAt(const Eigen::VectorXd& x) const {
  const NormalEquations normal = normalEquations(x, problem_.free);
  return unidentifiedPart(
      normal.information, problem_.free, problem_.model->space(), options_.unobservable_stddev);
}

/// F×F: what the prior of held directions tells of the estimated coordinates.
Eigen::MatrixXd Estimator::priorInformation() const {
  const Eigen::MatrixXd directions = prior_.directions(estimated_, Eigen::all);
  return directions * prior_.covariance.ldlt().solve(directions.transpose());
}

/// One least-squares solution over the active observations; its path is kept for the error history.
LeastSquaresResult Estimator::solve(const Eigen::VectorXd& start, Loss loss, double transition) {
  LeastSquaresInput input;
  input.problem = &problem_;
  input.evaluator = &evaluator_;
  input.whitening = &whitening_;
  input.active = active_;
  input.free = free_;
  input.start = start;
  input.prior = prior_;
  input.loss = loss;
  input.loss_transition = transition;
  input.max_iterations = options_.max_iterations;
  // A robust pass only sorts the observations: the last digits are the plain solution's.
  input.parameter_tolerance = loss == Loss::kSquared ? 1e-12 : 1e-6;
  LeastSquaresResult result = solveLeastSquares(input);
  result_.solve_time += result.solve_time;
  path_.insert(path_.end(), result.path.begin() + (path_.empty() ? 0 : 1), result.path.end());
  x_ = result.solution();
  result_.termination = result.termination;
  return result;
}

/// Squared whitened norms of all observations.
std::vector<double> Estimator::whitenedSquares(const Eigen::VectorXd& x) const {
  std::vector<double> squares(whitening_.size());
  for (std::size_t n = 0; n < squares.size(); ++n) {
    squares[n] = (whitening_[n] * evaluator_.residual(n, x)).squaredNorm();
  }
  return squares;
}

/// Solves, and once more with the weights at the solution where they depend on it.
bool Estimator::solveReweighted() {
  solve(x_, Loss::kSquared, 0.0);
  if (result_.termination == Termination::kConverged && updateWeights(x_)) {
    solve(x_, Loss::kSquared, 0.0);
  }
  return result_.termination == Termination::kConverged;
}

/// Squared whitened norm beyond which an observation is an outlier.
double Estimator::outlierLimit() const {
  return chiSquareLimit(kComponents,
                        options_.false_alarm_probability / static_cast<double>(active_.size()));
}

/// Marks as inactive what does not fit the present solution, and as active again what does. Returns
/// whether the set changed.
bool Estimator::rejectOutliers() {
  constexpr double kMedianOfThree = 2.366;  // of the χ² distribution with three degrees of freedom
  const double limit = outlierLimit();
  std::vector<double> squares = whitenedSquares(x_);
  std::vector<double> sorted = squares;
  std::nth_element(sorted.begin(),
                   sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  // Where the stated noise is too small for most observations, outliers stand out of the actual
  // scatter; the misfit itself is told by the reduced χ².
  const double scale = std::max(1.0, sorted[sorted.size() / 2] / kMedianOfThree);
  bool changed = false;
  for (std::size_t n = 0; n < squares.size(); ++n) {
    const bool fits = squares[n] <= limit * scale;
    changed = changed || fits != active_[n];
    active_[n] = fits;
  }
  return changed;
}

/// A plain solution where all observations fit it; otherwise a robust pass from the prior finds the
/// outliers and a plain solution runs without them. Returns whether it converged.
bool Estimator::solveWithoutOutliers() {
  constexpr int kMaxRounds = 5;
  // The robust losses take over somewhat below the limit, where faultless observations are rare.
  constexpr double kTransitionShare = 0.75;
  const double transition = std::sqrt(kTransitionShare * outlierLimit());
  std::fill(active_.begin(), active_.end(), true);
  path_.clear();
  x_ = problem_.prior.x;
  updateWeights(x_);
  if (!hasEnoughObservations()) {
    result_.termination = Termination::kTooFewObservations;
    return false;
  }
  const bool plain_converged = solveReweighted();
  std::vector<double> squares = whitenedSquares(x_);
  if (plain_converged &&
      *std::max_element(squares.begin(), squares.end()) <= transition * transition) {
    return true;  // within the quadratic part of the robust loss: it has the same minimum
  }
  path_.clear();
  solve(problem_.prior.x, Loss::kHuber, transition);
  updateWeights(x_);
  squares = whitenedSquares(x_);
  std::nth_element(squares.begin(),
                   squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2),
                   squares.end());
  const double scatter = std::max(1.0, std::sqrt(squares[squares.size() / 2] / kComponents));
  solve(x_, Loss::kCauchy, transition * scatter);
  for (int round = 0; round < kMaxRounds && (rejectOutliers() || round == 0); ++round) {
    if (!hasEnoughObservations()) {
      result_.termination = Termination::kTooFewObservations;
      return false;
    }
    if (!solveReweighted()) {
      return false;
    }
  }
  return true;
}

Estimate Estimator::run() {
  constexpr int kFreeRounds = 2;
  UnidentifiedPart open;
  open.directions.resize(problem_.prior.x.size(), 0);
  setFree(open);
  updateWeights(problem_.prior.x);
  result_.belief = problem_.prior;
  open = unidentifiedAt(problem_.prior.x);
  for (int round = 0;; ++round) {
    setFree(open);
    result_.unobservable = open.coordinates;
    result_.open_directions = open.directions;
    if (estimated_.empty()) {
      result_.termination = Termination::kNothingObservable;
      return result_;
    }
    if (!solveWithoutOutliers()) {
      return result_;
    }
    // The solution may see what the prior did not, and the other way round. Should the two views
    // not agree soon, what either calls weak stays at the prior, and the set can only grow.
    UnidentifiedPart seen = unidentifiedAt(x_);
    const bool same_directions = seen.directions.cols() == open.directions.cols();
    if (round >= kFreeRounds) {
      std::vector<Eigen::Index> either;
      std::set_union(seen.coordinates.begin(),
                     seen.coordinates.end(),
                     open.coordinates.begin(),
                     open.coordinates.end(),
                     std::back_inserter(either));
      seen.coordinates = std::move(either);
    }
    if (seen.coordinates == open.coordinates && (same_directions || round >= kFreeRounds)) {
      break;
    }
    open = std::move(seen);
  }
  concludeChiSquare();
  concludeCovariance();
  concludeResiduals();
  concludeErrorHistory();
  return result_;
}

void Estimator::concludeChiSquare() {
  constexpr double kSignificance = 1e-3;
  const std::vector<double> squares = whitenedSquares(x_);
  double chi_square = 0.0;
  for (std::size_t n = 0; n < squares.size(); ++n) {
    chi_square += active_[n] ? squares[n] : 0.0;
  }
  result_.degrees_of_freedom =
      kComponents * static_cast<int>(activeCount()) -
      (static_cast<int>(estimated_.size()) - static_cast<int>(prior_.directions.cols()));
  if (result_.degrees_of_freedom == 0) {
    return;
  }
  const double freedom = result_.degrees_of_freedom;
  result_.reduced_chi_square = chi_square / freedom;
  if (chi_square > chiSquareLimit(freedom, kSignificance)) {
    result_.covariance_scale = std::sqrt(result_.reduced_chi_square);
  }
}

/// Fills belief and condition number from the solution. With N the information of the estimated
/// coordinates, that of the prior of held directions included, δx = −N⁻¹ Σ JᵀS⁻¹ (noise + J_held
/// δheld), and noise, prior and held coordinates are independent of each other.
void Estimator::concludeCovariance() {
  const NormalEquations normal = normalEquations(x_, estimated_);
  const auto count = static_cast<Eigen::Index>(estimated_.size());
  result_.condition_number = judgeInformation(normal.information, options_.unobservable_stddev)
                                 .identified_condition_number;
  const Eigen::MatrixXd prior_information = priorInformation();
  inverse_ =
      (normal.information + prior_information).llt().solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::MatrixXd noise_covariance = inverse_ * normal.noise * inverse_;
  const Eigen::MatrixXd prior_covariance = inverse_ * prior_information * inverse_;
  Eigen::MatrixXd covariance = problem_.prior.covariance;
  for (const Eigen::Index a : estimated_) {
    covariance.row(a).setZero();
    covariance.col(a).setZero();
  }
  const Eigen::MatrixXd gain = -inverse_ * normal.others;  // F×P: ∂estimated/∂held
  with_held_ = gain * covariance;
  own_covariance_ = noise_covariance + prior_covariance + with_held_ * gain.transpose();

  const double scale = result_.covariance_scale * result_.covariance_scale;
  const Eigen::MatrixXd own = own_covariance_ + (scale - 1.0) * noise_covariance;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index a = estimated_[static_cast<std::size_t>(k)];
    covariance.row(a) += with_held_.row(k);
    covariance.col(a) += with_held_.row(k).transpose();
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index m = 0; m < count; ++m) {
      covariance(estimated_[static_cast<std::size_t>(k)], estimated_[static_cast<std::size_t>(m)]) =
          0.5 * (own(k, m) + own(m, k));
    }
  }
  result_.belief.x = x_;
  result_.belief.covariance = covariance;
}

/// Covariance of a residual after the solution: smaller than the observation's own for those that
/// took part in it, larger for those that did not.
Eigen::Matrix3d Estimator::residualCovariance(std::size_t observation,
                                              const LinearizedObservation& linear,
                                              const std::vector<bool>& held) const {
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, static_cast<Eigen::Index>(estimated_.size()));
  for (Eigen::Index k = 0; k < J.cols(); ++k) {
    J.col(k) = linear.jacobian.col(estimated_[static_cast<std::size_t>(k)]);
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3> with_others(J.cols(), 3);
  with_others.setZero();
  for (const Eigen::Index b : linear.columns) {
    with_others += with_held_.col(b) * linear.jacobian.col(b).transpose();
  }
  const Eigen::Matrix3d crossed = J.lazyProduct(with_others);
  Eigen::Matrix3d covariance = evaluator_.covariance(observation, linear, held) + crossed +
                               crossed.transpose() +
                               J.lazyProduct(own_covariance_).eval().lazyProduct(J.transpose());
  if (active_[observation]) {
    const Eigen::Matrix3d weight = whitening_[observation].transpose() * whitening_[observation];
    const Eigen::Matrix3d noise = evaluator_.noise(observation, linear);
    const Eigen::Matrix3d shared =
        noise * weight * J.lazyProduct(inverse_).eval().lazyProduct(J.transpose());
    covariance -= shared + shared.transpose();
    // A residual that its own parameters absorb wholly has no variance left: keep a floor.
    constexpr double kFloor = 1e-6;
    covariance += kFloor * noise;
  }
  return covariance;
}

void Estimator::concludeResiduals() {
  const std::vector<bool> held = heldCoordinates();
  LinearizedObservation linear;
  result_.residuals.reserve(whitening_.size());
  for (std::size_t n = 0; n < whitening_.size(); ++n) {
    evaluator_.linearize(n, x_, linear);
    ObservationResidual entry;
    entry.observation = problem_.observations[n];
    entry.residual = linear.residual;
    entry.rejected = !active_[n];
    const Eigen::LDLT<Eigen::Matrix3d> factor(residualCovariance(n, linear, held));
    entry.standardized =
        std::sqrt(std::max(0.0, linear.residual.dot(factor.solve(linear.residual))) / kComponents);
    result_.residuals.push_back(entry);
  }
}

void Estimator::concludeErrorHistory() {
  const ErrorMeasure measure = errorMeasure(problem_.observations);
  for (const Eigen::VectorXd& x : path_) {
    double sum = 0.0;
    for (std::size_t n = 0; n < whitening_.size(); ++n) {
      if (!active_[n]) {
        continue;
      }
      const Eigen::Vector3d residual = evaluator_.residual(n, x);
      switch (measure) {
        case ErrorMeasure::kOrientation:
          sum += residual.norm();
          break;
        case ErrorMeasure::kTorque:
          sum += residual.squaredNorm();
          break;
        case ErrorMeasure::kStandardized:
          sum += (whitening_[n] * residual).squaredNorm() / kComponents;
          break;
      }
    }
    const double mean = sum / static_cast<double>(activeCount());
    result_.error_history.push_back(measure == ErrorMeasure::kOrientation ? mean : std::sqrt(mean));
  }
  result_.iterations = static_cast<int>(path_.size()) - 1;
}

}  // namespace

void validate(const EstimationOptions& options) {
  const auto require = [](bool holds, const char* message) {
    if (!holds) {
      throw ConfigError(message);
    }
  };
  require(options.max_iterations > 0, "estimation.max_iterations must be at least 1.");
  require(options.unobservable_stddev > 0.0 && options.unobservable_stddev <= 1.0,
          "estimation.unobservable_stddev must lie in (0, 1] rad.");
  require(options.false_alarm_probability > 0.0 && options.false_alarm_probability < 0.5,
          "estimation.false_alarm_probability must lie in (0, 0.5).");
  require(options.max_rejected_fraction >= 0.0 && options.max_rejected_fraction < 0.5,
          "estimation.max_rejected_fraction must lie in [0, 0.5).");
  require(options.max_reduced_chi_square > 1.0, "estimation.max_reduced_chi_square must exceed 1.");
  require(options.current_threshold > 0.0, "estimation.current_threshold must be positive [A].");
  require(options.min_joint_motion > 0.0, "estimation.min_joint_motion must be positive [rad].");
  require(options.default_orientation_stddev > 0.0,
          "estimation.default_orientation_stddev must be positive [rad].");
  require(options.default_torque_stddev > 0.0,
          "estimation.default_torque_stddev must be positive [N.m].");
}

ErrorMeasure errorMeasure(const std::vector<Observation>& observations) {
  const auto is_orientation = [](const Observation& observation) {
    return observation.quantity == Quantity::kOrientation;
  };
  if (std::all_of(observations.begin(), observations.end(), is_orientation)) {
    return ErrorMeasure::kOrientation;
  }
  return std::none_of(observations.begin(), observations.end(), is_orientation)
             ? ErrorMeasure::kTorque
             : ErrorMeasure::kStandardized;
}

Estimate estimate(const EstimationProblem& problem, const EstimationOptions& options) {
  checkProblem(problem);
  return Estimator(problem, options).run();
}

}  // namespace sac
