#include "spherical_actuator_calibration/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "axis_modes.hpp"
#include "estimate_conclusion.hpp"
#include "held_prior.hpp"
#include "problem_check.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/least_squares.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"
#include "spherical_actuator_calibration/estimation/unidentified_part.hpp"
#include "weighted_observations.hpp"

namespace sac {
namespace {

/// Half width of the search for other modes of a pole or coil: six usual tolerances [rad].
constexpr double kModeRange = 0.18;

/// The steps of one estimation. Invariant: the weights belong to the last call of updateWeights().
class Estimator {
 public:
  Estimator(const EstimationProblem& problem, const EstimationOptions& options)
      : problem_(problem),
        options_(options),
        observations_(problem, options),
        start_(problem.prior.x) {
    solution_.problem = &problem;
    solution_.options = &options;
    solution_.observations = &observations_;
  }

  Estimate run();

 private:
  void setFree(const UnidentifiedPart& part);
  bool updateWeights(const Eigen::VectorXd& x) { return observations_.updateWeights(x, held_); }
  using Which = WeightedObservations::Which;
  UnidentifiedPart unidentifiedAt(const Eigen::VectorXd& x, Which which = Which::kActive) const;
  void noteRejectedAway(const UnidentifiedPart& seen);
  bool refineOpen(int round, UnidentifiedPart& open);
  void widenAmbiguous();
  LeastSquaresInput inputFrom(const Eigen::VectorXd& start, Loss loss) const;
  void solve(const Eigen::VectorXd& start, Loss loss, double transition);
  bool stepOn(double longest);
  bool solveReweighted();
  bool solveRobustly(double transition);
  bool solveWithoutOutliers();
  const std::vector<AxisMode>& modes();
  void takeBetterModes();
  double robustMisfit() const;
  double outlierLimit() const;
  double transition() const;
  bool rejectOutliers();
  bool hasEnoughObservations();

  const EstimationProblem& problem_;
  const EstimationOptions& options_;
  WeightedObservations observations_;
  Eigen::VectorXd start_;   ///< the prior, but for axes that were found elsewhere
  std::vector<bool> held_;  ///< per coordinate: not estimated
  Solution solution_;
  Estimate result_;
  std::vector<AxisMode> modes_;
  Eigen::VectorXd modes_at_;  ///< the solution that modes_ are the other modes of
};

/// Chooses the coordinates to estimate, the free ones of the problem without those held whole, and
/// the prior of the directions that are held.
void Estimator::setFree(const UnidentifiedPart& part) {
  modes_at_.resize(0);
  solution_.estimated.clear();
  std::set_difference(problem_.free.begin(),
                      problem_.free.end(),
                      part.coordinates.begin(),
                      part.coordinates.end(),
                      std::back_inserter(solution_.estimated));
  held_.assign(static_cast<std::size_t>(problem_.prior.x.size()), true);
  for (const Eigen::Index parameter : solution_.estimated) {
    held_[static_cast<std::size_t>(parameter)] = false;
  }
  for (Eigen::Index p = 0; p < start_.size(); ++p) {
    start_[p] = held_[static_cast<std::size_t>(p)] ? problem_.prior.x[p] : start_[p];
  }
  solution_.prior = heldPrior(problem_, part.directions, solution_.estimated);
}

/// What observations leave open of the free coordinates of the problem, at x.
UnidentifiedPart Estimator::unidentifiedAt(const Eigen::VectorXd& x, Which which) const {
  Eigen::MatrixXd information = observations_.information(x, problem_.free, which);
  information += statedInformation(problem_.model->space(), problem_.free);
  return unidentifiedPart(
      information, problem_.free, problem_.model->space(), options_.unobservable_stddev);
}

/// Keeps in mind what only the rejection of observations has left open.
void Estimator::noteRejectedAway(const UnidentifiedPart& seen) {
  const UnidentifiedPart by_all = unidentifiedAt(solution_.x(), Which::kAll);
  std::vector<Eigen::Index>& away = result_.rejected_away;
  away.clear();
  const Eigen::Index first = problem_.model->space().pole(0);
  const Eigen::Index last = problem_.model->space().effect();
  for (const Eigen::Index p : seen.coordinates) {
    if (p >= first && p < last &&
        !std::binary_search(by_all.coordinates.begin(), by_all.coordinates.end(), p)) {
      away.push_back(p);
    }
  }
}

/// The active observations as they are weighed now, and the coordinates to estimate.
LeastSquaresInput Estimator::inputFrom(const Eigen::VectorXd& start, Loss loss) const {
  LeastSquaresInput input;
  input.evaluator = &observations_.evaluator();
  input.whitening = &observations_.whitening();
  input.shared = &observations_.shared();
  input.active = observations_.active();
  input.free = solution_.estimated;
  input.start = start;
  input.at_start = loss == Loss::kSquared ? &observations_.sum(start) : nullptr;
  input.prior = solution_.prior;
  input.loss = loss;
  input.max_iterations = options_.max_iterations;
  // A robust pass only sorts the observations: the last digits are the plain solution's.
  input.parameter_tolerance = loss == Loss::kSquared ? 1e-12 : 1e-6;
  return input;
}

/// One least-squares solution over the active observations; its path is kept for the error history.
void Estimator::solve(const Eigen::VectorXd& start, Loss loss, double transition) {
  LeastSquaresInput input = inputFrom(start, loss);
  input.loss_transition = transition;
  const LeastSquaresResult result = solveLeastSquares(input);
  result_.solve_time += result.solve_time;
  result_.termination = result.termination;
  std::vector<Eigen::VectorXd>& path = solution_.path;
  if (path.empty()) {
    path.push_back(problem_.prior.x);
  }
  path.insert(path.end(), result.path.begin() + (path.back() == start ? 1 : 0), result.path.end());
}

/// One step by the weights at the solution; false where it would be longer [rad].
bool Estimator::stepOn(double longest) {
  const auto moved = afterOneStep(inputFrom(solution_.x(), Loss::kSquared));
  if (!moved || !((*moved - solution_.x()).lpNorm<Eigen::Infinity>() <= longest)) {
    return false;
  }
  solution_.path.push_back(*moved);
  return true;
}

/// Goes on with the weights at each point, until the solution does not depend on where the path
/// began. A single step leads on as long as steps shrink, a whole solution elsewhere.
bool Estimator::solveReweighted() {
  constexpr int kMaxSteps = 10;
  constexpr double kSettled = 1e-12;  // [rad] left to go
  constexpr double kFine = 1e-9;      // [rad]; below it steps that do not shrink are rounding
  constexpr double kNear = 2e-3;      // [rad]; twice the longest step that is taken as it is
  constexpr double kLeastShrinkage = 0.05;
  double before = kNear;
  solve(solution_.path.empty() ? start_ : solution_.x(), Loss::kSquared, 0.0);
  bool goes_on = result_.termination == Termination::kConverged && updateWeights(solution_.x());
  for (int n = 0; goes_on && n < kMaxSteps; ++n) {
    const Eigen::VectorXd from = solution_.x();
    if (!stepOn(0.5 * before)) {
      solve(from, Loss::kSquared, 0.0);
    }
    updateWeights(solution_.x());
    const double moved = (solution_.x() - from).lpNorm<Eigen::Infinity>();
    const double shrinkage = std::max(moved / before, kLeastShrinkage);
    goes_on = result_.termination == Termination::kConverged && moved * shrinkage > kSettled &&
              (shrinkage <= 0.5 || moved > kFine);
    before = moved;
  }
  return result_.termination == Termination::kConverged;
}

/// Squared whitened norm beyond which an observation is an outlier.
double Estimator::outlierLimit() const {
  return chiSquareLimit(
      kObservationComponents,
      options_.false_alarm_probability / static_cast<double>(observations_.size()));
}

/// Marks as inactive what does not fit the present solution, and as active again what does. Returns
/// whether the set changed.
bool Estimator::rejectOutliers() {
  const double median = medianOf(observations_.squares(solution_.x(), outlierLimit()));
  // Where the stated noise is too small for most observations, outliers stand out of the actual
  // scatter; the misfit itself is told by the reduced χ².
  const double limit = outlierLimit() * std::max(1.0, median / kMedianOfChiSquare3);
  const auto squares = observations_.squares(solution_.x(), limit);
  bool changed = false;
  for (std::size_t n = 0; n < squares.size(); ++n) {
    changed = observations_.setActive(n, squares[n] <= limit) || changed;
  }
  return changed;
}

bool Estimator::hasEnoughObservations() {
  const std::size_t stated = statedOf(problem_.model->space(), solution_.estimated).size();
  const std::size_t unknowns = solution_.estimated.size() - stated;
  if (static_cast<std::size_t>(kObservationComponents) * observations_.activeCount() >= unknowns) {
    return true;
  }
  result_.termination = Termination::kTooFewObservations;
  return false;
}

/// Whitened norm at which robust losses take over: somewhat below the limit, where faultless
/// observations are rare.
double Estimator::transition() const {
  constexpr double kTransitionShare = 0.75;
  return std::sqrt(kTransitionShare * outlierLimit());
}

/// A robust pass from the start finds the outliers, and a plain solution runs without them.
bool Estimator::solveRobustly(double transition) {
  constexpr int kMaxRounds = 5;
  solution_.path.clear();
  solve(start_, Loss::kHuber, transition);
  updateWeights(solution_.x());
  const double median = medianOf(observations_.squares(solution_.x(), outlierLimit()));
  const double scatter = std::max(1.0, std::sqrt(median / kObservationComponents));
  solve(solution_.x(), Loss::kCauchy, transition * scatter);
  for (int round = 0; round < kMaxRounds && (rejectOutliers() || round == 0); ++round) {
    if (!hasEnoughObservations() || !solveReweighted()) {
      return false;
    }
  }
  return true;
}

/// A plain solution where all observations fit it, a robust one otherwise. Returns whether it
/// converged.
bool Estimator::solveWithoutOutliers() {
  const double transition = this->transition();
  observations_.activateAll();
  solution_.path.clear();
  updateWeights(start_);
  if (!hasEnoughObservations()) {
    return false;
  }
  if (solveReweighted()) {
    const std::vector<double> squares = observations_.squares(solution_.x());
    if (*std::max_element(squares.begin(), squares.end()) <= transition * transition) {
      return true;  // within the quadratic part of the robust loss: it has the same minimum
    }
  }
  return solveRobustly(transition);
}

/// Σ ρ over all observations, those that do not serve included, by which two solutions compare.
double Estimator::robustMisfit() const {
  const double limit = std::pow(transition(), 2);
  double sum = 0.0;
  for (const double square : observations_.squares(solution_.x(), outlierLimit())) {
    sum += limit * std::log1p(square / limit);
  }
  return sum;
}

/// Other modes of the present solution.
const std::vector<AxisMode>& Estimator::modes() {
  if (modes_at_.size() == 0 || modes_at_ != solution_.x()) {
    const ModeSearch search{kModeRange, transition(), options_.tolerance};
    modes_ = otherModes(problem_, observations_, solution_.x(), solution_.estimated, search);
    modes_at_ = solution_.x();
  }
  return modes_;
}

/// Moves poles and coils whose torques, also those rejected, fit far better elsewhere, and solves
/// again from there; else an axis that rests in a wrong place rejects the very samples that would
/// call it back. Keeps the better of both solutions.
void Estimator::takeBetterModes() {
  constexpr int kMaxRounds = 3;
  for (int round = 0; round < kMaxRounds; ++round) {
    const double worthwhile = outlierLimit();
    Eigen::VectorXd moved = solution_.x();
    std::map<Eigen::Index, double> best;
    for (const AxisMode& mode : modes()) {
      double& gain = best.try_emplace(mode.first, worthwhile).first->second;
      if (mode.gain > gain) {
        gain = mode.gain;
        moved.segment<2>(mode.first) = mode.place;
      }
    }
    if (moved == solution_.x()) {
      return;
    }
    const double before = robustMisfit();
    const WeightedObservations::Setting setting_before = observations_.setting();
    const Solution solution_before = solution_;
    const Estimate result_before = result_;
    const Eigen::VectorXd start_before = std::exchange(start_, moved);
    if (!solveWithoutOutliers() || robustMisfit() > before) {
      observations_.restore(setting_before);
      solution_ = solution_before;
      result_ = result_before;
      start_ = start_before;
      return;
    }
  }
}

/// Looks from the solution at what is open: it may see what the prior did not, and the other way
/// round. Should the two views not agree soon, what either calls weak stays at the prior, and the
/// set can only grow. Returns whether `open` changed.
bool Estimator::refineOpen(int round, UnidentifiedPart& open) {
  constexpr int kFreeRounds = 2;
  UnidentifiedPart seen = unidentifiedAt(solution_.x());
  if (round == 0 && !seen.coordinates.empty()) {
    noteRejectedAway(seen);
  }
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
    return false;
  }
  open = std::move(seen);
  return true;
}

/// Axes that other places explain nearly as well, manufacture included, are told, with all these
/// places in their uncertainty.
void Estimator::widenAmbiguous() {
  constexpr double kNearlyAsWell = 16.0;  // of χ²: four standard deviations
  for (const AxisMode& mode : modes()) {
    if (mode.gain > -kNearlyAsWell) {
      const Eigen::Vector2d apart = mode.place - solution_.x().segment<2>(mode.first);
      result_.belief.covariance.block<2, 2>(mode.first, mode.first) += apart * apart.transpose();
      if (result_.ambiguous.empty() || result_.ambiguous.back() != mode.first) {
        result_.ambiguous.push_back(mode.first);
      }
    }
  }
}

Estimate Estimator::run() {
  result_.belief = problem_.prior;
  UnidentifiedPart open;
  open.directions.resize(problem_.prior.x.size(), 0);
  setFree(open);
  updateWeights(problem_.prior.x);
  open = unidentifiedAt(problem_.prior.x);
  int round = 0;
  do {
    setFree(open);
    result_.unobservable = open.coordinates;
    result_.open_directions = open.directions;
    if (solution_.estimated.empty()) {
      result_.termination = Termination::kNothingObservable;
      return result_;
    }
    if (!solveWithoutOutliers()) {
      return result_;
    }
    takeBetterModes();
  } while (refineOpen(round++, open));
  std::vector<Eigen::Index> lost;
  std::set_intersection(result_.rejected_away.begin(),
                        result_.rejected_away.end(),
                        open.coordinates.begin(),
                        open.coordinates.end(),
                        std::back_inserter(lost));
  result_.rejected_away = std::move(lost);
  conclude(solution_, result_);
  widenAmbiguous();
  return std::move(result_);
}

}  // namespace

Estimate estimate(const EstimationProblem& problem, const EstimationOptions& options) {
  checkProblem(problem);
  return Estimator(problem, options).run();
}

}  // namespace sac
