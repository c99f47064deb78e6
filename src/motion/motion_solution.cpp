#include "motion_solution.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "delay_search.hpp"
#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"

namespace sac {
namespace {

/// Where a step is as good as none, in standard deviations of all coordinates together.
constexpr double kSettled = 0.02;

double medianOrOne(std::vector<double> values) {
  return values.empty() ? 1.0 : medianOf(std::move(values));
}

}  // namespace

MotionDescent::MotionDescent(const MotionProblem& problem,
                             const EstimationOptions& estimation,
                             const MotionOptions& options,
                             MotionTerms& terms)
    : problem_(problem),
      estimation_(estimation),
      options_(options),
      terms_(terms),
      x_(problem.start.size() > 0 ? problem.start : problem.prior.x),
      open_limit_(estimation.unobservable_stddev),
      estimated_(problem.free) {
  open_.directions.resize(x_.size(), 0);
}

MotionSums MotionDescent::sumsAt(const Eigen::VectorXd& x) {
  return {terms_.balance(x), terms_.orientation(x)};
}

/// Misfits count against their usual size: far from the solution all windows fit badly.
void MotionDescent::rescale() {
  std::vector<double> windows;
  std::vector<double> orientations;
  for (std::size_t n = 0; n < terms_.windowCount(); n += terms_.every()) {
    windows.push_back(terms_.windows()[n].square);
  }
  for (const OrientationTerm& term : terms_.orientations().terms()) {
    if (term.is_known) {
      orientations.push_back(term.square);
    }
  }
  terms_.setScales(std::max(1.0, medianOrOne(windows)), std::max(1.0, medianOrOne(orientations)));
}

double MotionDescent::cost(const MotionSums& sums) const {
  return sums.misfit() + (x_ - problem_.prior.x).dot(pull());
}

Eigen::MatrixXd MotionDescent::priorInformation() const {
  const ParameterSpace& space = problem_.model->space();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(x_.size(), x_.size());
  information(estimated_, estimated_) += statedInformation(space, estimated_);
  if (open_.directions.cols() > 0) {
    const Eigen::MatrixXd& D = open_.directions;
    // As uncertain as the prior says, or as far from it as it was left.
    const Eigen::VectorXd apart = D.transpose() * (x_ - problem_.prior.x);
    Eigen::MatrixXd covariance = D.transpose() * problem_.prior.covariance * D;
    if (is_fine_) {
      covariance += apart * apart.transpose();
    }
    information += D * solveSemidefinite(covariance, D.transpose());
  }
  return information;
}

/// Towards the prior. What is open is a curve, not a direction: a long way along it leaves what
/// fits, and tells nothing. It stays where the coarse steps have left it.
Eigen::VectorXd MotionDescent::pull() const {
  Eigen::VectorXd apart = x_ - problem_.prior.x;
  if (is_fine_) {
    const Eigen::MatrixXd& D = open_.directions;
    apart -= D * (D.transpose() * apart);
  }
  return priorInformation() * apart;
}

void MotionDescent::judgeOpen() {
  const Eigen::MatrixXd all = sums_.information();
  Eigen::MatrixXd information = all(problem_.free, problem_.free);
  const ParameterSpace& space = problem_.model->space();
  information += statedInformation(space, problem_.free);
  const Eigen::Index before = countOpen();
  open_ = unidentifiedPart(information, problem_.free, space, open_limit_);
  // What comes and goes stays.
  constexpr double kStricter = 0.7;
  if (is_fine_ && countOpen() < before) {
    open_limit_ *= kStricter;
  }
  estimated_.clear();
  std::set_difference(problem_.free.begin(),
                      problem_.free.end(),
                      open_.coordinates.begin(),
                      open_.coordinates.end(),
                      std::back_inserter(estimated_));
  for (const Eigen::Index p : open_.coordinates) {
    x_[p] = problem_.prior.x[p];
  }
}

/// Judges what is open, and linearises anew where that leads away: what was free for a while and is
/// held again goes back to the prior. That is no step of the descent, which would undo it.
void MotionDescent::holdOpen(const TermOrder& order) {
  constexpr double kFar = 1.0;
  const Eigen::VectorXd before = x_;
  judgeOpen();
  if (lengthOf(x_ - before) > kFar) {
    linearizeAt(x_, order);
  }
}

/// Levenberg–Marquardt, P entries: no further from where the terms are linearised than damping
/// allows, measured by the prior.
Eigen::VectorXd MotionDescent::step(double damping_of_all) {
  const Eigen::VectorXd damping = problem_.prior.covariance.diagonal().unaryExpr(
      [&](double variance) { return variance > 0.0 ? damping_of_all / variance : 0.0; });
  Eigen::MatrixXd all = sums_.information() + priorInformation();
  all.diagonal() += damping;
  const Eigen::MatrixXd information = all(estimated_, estimated_);
  const Eigen::VectorXd slope =
      sums_.gradient() + pull() + damping.cwiseProduct(x_ - linearized_at_);
  const Eigen::VectorXd gradient = slope(estimated_);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(x_.size());
  result(estimated_) = -solveSemidefinite(information, gradient);
  return result;
}

void MotionDescent::noteError() {
  const auto values = terms_.servingWindows() * static_cast<std::size_t>(terms_.valuesPerWindow());
  errors_.push_back(std::sqrt(sums_.balance.squaredMisfit() / static_cast<double>(values)));
}

/// Gauss–Newton with the windows as they are linearised, until the next step is at most `tolerance`
/// standard deviations long in all; false where nothing can be told. Weights follow the misfits.
bool MotionDescent::settle(double tolerance) {
  constexpr int kMostSteps = 20;
  for (int n = 0; n < kMostSteps; ++n) {
    rescale();
    sums_ = sumsAt(x_);
    judgeOpen();
    if (estimated_.empty()) {
      return true;
    }
    const Eigen::VectorXd forward = step(damping_);
    if (!forward.allFinite()) {
      return false;
    }
    if (lengthOf(forward) <= tolerance) {
      return true;
    }
    x_ += forward;
  }
  return true;
}

/// In standard deviations of all coordinates together.
double MotionDescent::lengthOf(const Eigen::VectorXd& change) const {
  return std::sqrt(std::max(0.0, change.dot(sums_.information() * change)));
}

void MotionDescent::linearizeAt(const Eigen::VectorXd& x, const TermOrder& order) {
  x_ = x;
  linearized_at_ = x;
  terms_.linearize(x_, order);
  sums_ = sumsAt(x_);
}

/// Linearises anew, half way back to `start` as long as the misfit has grown; how far that is.
double MotionDescent::advance(const Eigen::VectorXd& start, const TermOrder& order) {
  constexpr int kMostHalvings = 6;
  constexpr double kShort = 1.0;
  const Eigen::VectorXd end = x_;
  x_ = start;
  const double before = cost(sumsAt(start));
  double length = lengthOf(end - start);
  int halvings = 0;
  for (linearizeAt(end, order); cost(sums_) > before; ++halvings) {
    if (length < kShort || halvings == kMostHalvings) {
      break;
    }
    length *= 0.5;
    linearizeAt(start + 0.5 * (x_ - start), order);
  }
  adaptDamping(halvings);
  ++iterations_;
  noteError();
  return length;
}

/// Directions that the data hardly tell bend soonest: the whole step would be as short as they
/// allow.
void MotionDescent::adaptDamping(int halvings) {
  constexpr double kFirst = 1e-3;
  constexpr double kMost = 1e6;  // nothing moves
  if (halvings > 0) {
    damping_ = std::min(kMost, std::max(damping_, kFirst) * std::pow(4.0, halvings));
    return;
  }
  damping_ = damping_ > kFirst ? 0.1 * damping_ : 0.0;
}

void MotionDescent::solveCoarsely() {
  constexpr int kMostSteps = 8;
  constexpr double kNear = 3.0;
  constexpr std::size_t kEnough = 100;  // windows
  constexpr double kLoose = 0.1;        // coordinates may go so far in one step [rad]
  terms_.setScales(1e12, 1e12);
  TermOrder order;
  order.balance.stride = terms_.coarseStride();
  if (terms_.places().current_delay >= 0) {
    const Eigen::VectorXd loose = Eigen::VectorXd::Constant(x_.size(), kLoose);
    x_[terms_.places().current_delay] =
        searchDelay(problem_, {0.0, options_.largest_delay}, loose, terms_).delay;
  }
  order.every = std::max<std::size_t>(1, terms_.windowCount() / kEnough);
  linearizeAt(x_, order);
  rescale();
  sums_ = sumsAt(x_);
  noteError();
  // Where coarse steps find no end, fine ones may.
  for (int n = 0; n < kMostSteps; ++n) {
    holdOpen(order);
    const Eigen::VectorXd start = x_;
    x_ += step(damping_);
    if (!x_.allFinite()) {
      x_ = start;
      return;
    }
    if (advance(start, order) <= kNear) {
      return;
    }
    rescale();
    sums_ = sumsAt(x_);
  }
}

bool MotionDescent::solveFinely(const std::function<bool()>& weigh_anew) {
  // A step as short as this one changes the derivatives by nothing that counts.
  constexpr double kEnd = 1.0;
  // Where nothing fits, outliers come and go for ever.
  constexpr int kMostWeighings = 6;
  int weighings = 0;
  TermOrder order;
  order.balance.covariance = true;
  linearizeAt(x_, order);
  order.balance.covariance = false;
  is_fine_ = true;
  for (int iteration = 0; iteration < estimation_.max_iterations; ++iteration) {
    holdOpen(order);
    const Eigen::VectorXd start = x_;
    bool settled = settle(kSettled);
    // Far from the solution everything is an outlier.
    const bool is_near = iteration > 0 || lengthOf(x_ - start) <= kEnd;
    while (settled && is_near && weighings < kMostWeighings && weigh_anew()) {
      ++weighings;
      settled = settle(kSettled);
    }
    if (!settled) {
      return false;
    }
    if (estimated_.empty() || (lengthOf(x_ - start) <= kEnd && lengthOf(step(0.0)) <= kEnd)) {
      return true;
    }
    advance(start, order);
  }
  return false;
}

bool MotionDescent::settleAnew() {
  if (!settle(kSettled)) {
    return false;
  }
  if (!terms_.areSummed()) {
    return true;
  }
  linearizeAt(x_, {});
  return settle(kSettled);
}

}  // namespace sac
