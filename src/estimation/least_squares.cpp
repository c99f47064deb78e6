#include "spherical_actuator_calibration/estimation/least_squares.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/information_factor.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

/// Close to Gauss–Newton from the first step: the prior lies within the basin as a rule.
constexpr double kFirstDamping = 1e-8;
constexpr double kLeastDamping = 1e-16;
constexpr double kLargestDamping = 1e16;
/// Of a coordinate that nothing tells at some point, as of a pole that left the reach of all coils:
/// without it there would be no step at all.
constexpr double kLeastDiagonal = 1e-6;
/// A step must bring at least this share of the decrease that the linear model promises.
constexpr double kLeastGain = 1e-3;
/// A smaller relative decrease of the cost cannot be told from its rounding.
constexpr double kCostRounding = 1e-13;
/// Size of coordinates for which the relative tolerance is meant at least: a tolerance of
/// manufacture [rad].
constexpr double kUsualSize = 0.03;
/// A step of less than so many tolerances is made of rounding once steps no longer shrink.
constexpr double kFineStep = 1e3;

/// ρ(s) of a squared whitened norm s, and its derivative: the weight of the observation.
struct LossValue {
  double value = 0.0;
  double weight = 1.0;
};

LossValue lossAt(Loss loss, double transition, double s) {
  const double limit = transition * transition;
  if (loss == Loss::kCauchy) {
    return {limit * std::log1p(s / limit), 1.0 / (1.0 + s / limit)};
  }
  if (loss == Loss::kHuber && s > limit) {
    const double norm = std::sqrt(s);
    return {2.0 * transition * norm - limit, transition / norm};
  }
  return {s, 1.0};
}

/// Cost, half its gradient and half its Gauss–Newton Hessian at one point, in the free coordinates.
struct NormalEquations {
  double cost = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;

  bool isFinite() const { return std::isfinite(cost) && information.allFinite(); }
};

/// What is minimised, summed up over the active observations.
class Objective {
 public:
  explicit Objective(const LeastSquaresInput& input)
      : input_(input), free_(input.start.size(), input.free) {
    if (input.prior.directions.cols() > 0) {
      const Cholesky factor(input.prior.covariance);
      prior_ = factor.half(input.prior.directions.transpose());
      prior_mean_ = factor.half(input.prior.mean);
    }
  }

  /// Where the sum over the observations is known already.
  NormalEquations atStart() const {
    InformationSum sum = input_.at_start->at(input_.free);
    double cost = sum.squaredMisfit();
    addPrior(input_.start, sum, cost);
    return {cost, sum.gradient(), sum.information()};
  }

  NormalEquations normalEquations(const Eigen::VectorXd& x) const {
    const ModelPoint point = input_.evaluator->at(x);
    InformationSum sum(free_.size());
    double cost = 0.0;
    LinearizedObservation linear;
    WhitenedObservation whitened;
    for (std::size_t n = 0; n < input_.active.size(); ++n) {
      if (input_.active[n] && !shares(n)) {
        input_.evaluator->linearize(n, point, linear);
        whiten(linear, (*input_.whitening)[n], free_, whitened);
        const LossValue value = loss(whitened.residual.squaredNorm());
        cost += value.value;
        sum.add(whitened, value.weight);
      }
    }
    addDwells(point, sum, cost);
    addPrior(x, sum, cost);
    return {cost, sum.gradient(), sum.information()};
  }

  Eigen::VectorXd moved(const Eigen::VectorXd& x, const Eigen::VectorXd& step) const {
    Eigen::VectorXd result = x;
    result(input_.free) += step;
    return result;
  }

 private:
  /// One active observation of a dwell.
  struct DwellMember {
    std::size_t observation = 0;
    Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< whitened
    double weight = 1.0;
  };

  std::size_t dwells() const { return input_.shared == nullptr ? 0 : input_.shared->dwells.size(); }
  bool shares(std::size_t n) const { return input_.shared != nullptr && input_.shared->shares[n]; }
  LossValue loss(double s) const { return lossAt(input_.loss, input_.loss_transition, s); }

  /// Weights of the members at the errors u of least cost, by reweighting from u = 0, where a gross
  /// error does not hide behind them. Returns the cost, that of u included.
  double weigh(std::vector<DwellMember>& members) const {
    constexpr int kMaxRounds = 20;
    constexpr double kSettled = 1e-6;
    SharedErrors errors = SharedErrors::Zero();
    double cost = 0.0;
    const int rounds = input_.loss == Loss::kSquared ? 1 : kMaxRounds;
    for (int round = 0; round < rounds; ++round) {
      DwellElimination elimination;
      for (DwellMember& member : members) {
        const SharedLoading& G = input_.shared->loading[member.observation];
        member.weight = loss((member.residual - G * errors).squaredNorm()).weight;
        elimination.add(G, member.residual, member.weight);
      }
      const SharedErrors before = std::exchange(errors, elimination.errors());
      cost = errors.squaredNorm();
      for (const DwellMember& member : members) {
        const SharedLoading& G = input_.shared->loading[member.observation];
        cost += loss((member.residual - G * errors).squaredNorm()).value;
      }
      if ((errors - before).norm() < kSettled) {
        break;
      }
    }
    return cost;
  }

  void addDwells(const ModelPoint& point, InformationSum& sum, double& cost) const {
    LinearizedObservation linear;
    std::vector<DwellMember> members;
    std::vector<WhitenedObservation> whitened;
    DwellSum dwell(free_.size());
    for (std::size_t d = 0; d < dwells(); ++d) {
      members.clear();
      whitened.clear();
      for (const std::size_t n : input_.shared->dwells[d]) {
        if (input_.active[n]) {
          input_.evaluator->linearize(n, point, linear);
          whitened.emplace_back();
          whiten(linear, (*input_.whitening)[n], free_, whitened.back());
          members.push_back({n, whitened.back().residual, 1.0});
        }
      }
      cost += weigh(members);
      dwell.begin();
      for (std::size_t m = 0; m < members.size(); ++m) {
        dwell.add(whitened[m], input_.shared->loading[members[m].observation], members[m].weight);
      }
      dwell.addTo(sum);
    }
  }

  void addPrior(const Eigen::VectorXd& x, InformationSum& sum, double& cost) const {
    if (prior_.rows() > 0) {
      const Eigen::VectorXd residual = prior_ * x - prior_mean_;
      sum.addDense(prior_(Eigen::all, input_.free), residual);
      cost += residual.squaredNorm();
    }
  }

  const LeastSquaresInput& input_;
  ChosenCoordinates free_;
  Eigen::MatrixXd prior_;       ///< whitened directions, d×P
  Eigen::VectorXd prior_mean_;  ///< whitened
};

/// Levenberg–Marquardt steps from one point to a better one, until the next would change nothing.
class Descent {
 public:
  Descent(const LeastSquaresInput& input, LeastSquaresResult& result)
      : input_(input), result_(result), objective_(input) {}

  Termination run() {
    const bool is_known = input_.at_start != nullptr && input_.loss == Loss::kSquared;
    NormalEquations normal =
        is_known ? objective_.atStart() : objective_.normalEquations(input_.start);
    for (int iteration = 0; iteration < input_.max_iterations; ++iteration) {
      if (!normal.isFinite() || !advance(normal)) {
        return Termination::kNumericalFailure;
      }
      if (is_converged_) {
        return Termination::kConverged;
      }
      normal = next_ ? *std::exchange(next_, std::nullopt)
                     : objective_.normalEquations(result_.path.back());
    }
    return Termination::kIterationLimit;
  }

 private:
  /// Takes the least damped step that does not raise the cost; false when there is none.
  bool advance(const NormalEquations& normal) {
    const Eigen::VectorXd x = result_.path.back();
    for (; damping_ <= kLargestDamping; raiseDamping()) {
      const std::optional<Eigen::VectorXd> step = dampedStep(normal);
      if (!step) {
        continue;
      }
      const Eigen::VectorXd moved = objective_.moved(x, *step);
      const bool is_fine = isFine(normal, x, *step);
      is_converged_ = isLast(x, *step, is_fine);
      next_.reset();
      const double gain = is_fine || is_converged_ ? 1.0 : gainOf(normal, moved, *step);
      if (gain > kLeastGain) {
        previous_step_ = step->norm();
        lowerDamping(gain);
        result_.path.push_back(moved);
        return true;
      }
    }
    return false;
  }

  /// Decrease of the cost over the one that the linear model promises. The cost comes with its
  /// derivatives: most steps are taken, and the next one needs them.
  double gainOf(const NormalEquations& normal,
                const Eigen::VectorXd& moved,
                const Eigen::VectorXd& step) {
    const double promised = -step.dot(2.0 * normal.gradient + normal.information * step);
    if (!(promised > 0.0)) {
      return 0.0;
    }
    next_ = objective_.normalEquations(moved);
    return (normal.cost - next_->cost) / promised;
  }

  /// Nielsen's rule, as Madsen, Nielsen and Tingleff give it: the better the linear model, the less
  /// damping.
  void lowerDamping(double gain) {
    const double factor = std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * gain - 1.0, 3));
    damping_ = std::max(factor * damping_, kLeastDamping);
    growth_ = 2.0;
  }

  void raiseDamping() {
    damping_ *= growth_;
    growth_ *= 2.0;
  }

  std::optional<Eigen::VectorXd> dampedStep(const NormalEquations& normal) const {
    const InformationFactor factor(
        normal.information, damping_ * normal.information.diagonal().cwiseMax(kLeastDiagonal));
    if (!factor.isPositive()) {
      return std::nullopt;
    }
    Eigen::VectorXd step = -factor.solve(normal.gradient);
    return step.allFinite() ? std::optional<Eigen::VectorXd>(std::move(step)) : std::nullopt;
  }

  /// Length that counts as nothing at x [rad].
  double tolerance(const Eigen::VectorXd& x) const {
    return input_.parameter_tolerance * (x.norm() + kUsualSize);
  }

  /// Whether a step is too small for the cost to judge it: rounding would.
  bool isFine(const NormalEquations& normal,
              const Eigen::VectorXd& x,
              const Eigen::VectorXd& step) const {
    return -step.dot(normal.gradient) <= kCostRounding * normal.cost ||
           step.norm() <= kFineStep * tolerance(x);
  }

  /// Whether nothing worth a step is left to go after this one. The next steps will shrink at least
  /// as this one did against the one before; where they no longer shrink, they are rounding.
  bool isLast(const Eigen::VectorXd& x, const Eigen::VectorXd& step, bool is_fine) const {
    const double length = step.norm();
    if (length <= tolerance(x)) {
      return true;
    }
    const bool is_first = previous_step_ == 0.0;
    const double shrinkage = is_first ? 1.0 : length / previous_step_;
    if (shrinkage > 0.5) {
      return is_fine && !is_first;
    }
    return length * shrinkage / (1.0 - shrinkage) <= tolerance(x);
  }

  const LeastSquaresInput& input_;
  LeastSquaresResult& result_;
  Objective objective_;
  std::optional<NormalEquations> next_;  ///< where the step taken led, if they are known
  double damping_ = kFirstDamping;
  double growth_ = 2.0;         ///< of the damping, at the next refusal
  double previous_step_ = 0.0;  ///< 0: there was none
  bool is_converged_ = false;
};

}  // namespace

std::optional<Eigen::VectorXd> afterOneStep(const LeastSquaresInput& input) {
  const Objective objective(input);
  const NormalEquations normal = objective.atStart();
  const InformationFactor factor(
      normal.information, kLeastDamping * normal.information.diagonal().cwiseMax(kLeastDiagonal));
  if (!factor.isPositive()) {
    return std::nullopt;
  }
  return objective.moved(input.start, -factor.solve(normal.gradient));
}

LeastSquaresResult solveLeastSquares(const LeastSquaresInput& input) {
  const auto begin = std::chrono::steady_clock::now();
  LeastSquaresResult result;
  result.path.push_back(input.start);
  result.termination = Descent(input, result).run();
  result.solve_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace sac
