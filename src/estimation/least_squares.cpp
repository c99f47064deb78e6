#include "spherical_actuator_calibration/estimation/least_squares.hpp"

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/estimation/damped_descent.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

/// Size of coordinates for which the relative tolerance is meant at least: a tolerance of
/// manufacture [rad].
constexpr double kUsualSize = 0.03;

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

/// What is minimised, summed up over the active observations.
class Objective {
 public:
  using Point = Eigen::VectorXd;

  explicit Objective(const LeastSquaresInput& input)
      : input_(input), free_(input.start.size(), input.free) {
    if (input.prior.directions.cols() > 0) {
      const Cholesky factor(input.prior.covariance);
      prior_ = factor.half(input.prior.directions.transpose());
      prior_mean_ = factor.half(input.prior.mean);
    }
  }

  /// Cost and derivatives come together: most steps are taken, and the next one needs them.
  double cost(const Eigen::VectorXd& x) {
    tried_at_ = x;
    tried_ = summedUp(x);
    return tried_.cost;
  }

  /// Where the sum over the observations is known already.
  NormalEquations atStart() const {
    InformationSum sum = input_.at_start->at(input_.free);
    double cost = sum.squaredMisfit();
    addPrior(input_.start, sum, cost);
    return {cost, sum.gradient(), sum.information()};
  }

  NormalEquations normalEquations(const Eigen::VectorXd& x) {
    if (tried_at_.size() == x.size() && tried_at_ == x) {
      return tried_;
    }
    return isKnownAtStart() && x == input_.start ? atStart() : summedUp(x);
  }

  Eigen::VectorXd moved(const Eigen::VectorXd& x, const Eigen::VectorXd& step) const {
    Eigen::VectorXd result = x;
    result(input_.free) += step;
    return result;
  }

  double nothing(const Eigen::VectorXd& x) const {
    return input_.parameter_tolerance * (x.norm() + kUsualSize);
  }

 private:
  bool isKnownAtStart() const {
    return input_.at_start != nullptr && input_.loss == Loss::kSquared;
  }

  NormalEquations summedUp(const Eigen::VectorXd& x) const {
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
  Eigen::VectorXd tried_at_;
  NormalEquations tried_;
};

}  // namespace

std::optional<Eigen::VectorXd> afterOneStep(const LeastSquaresInput& input) {
  const Objective objective(input);
  const std::optional<Eigen::VectorXd> step = dampedStep(objective.atStart());
  return step ? std::make_optional(objective.moved(input.start, *step)) : std::nullopt;
}

LeastSquaresResult solveLeastSquares(const LeastSquaresInput& input) {
  const auto begin = std::chrono::steady_clock::now();
  LeastSquaresResult result;
  result.path.push_back(input.start);
  DescentOptions options;
  options.max_iterations = input.max_iterations;
  // Close to Gauss–Newton: the prior lies within the basin as a rule.
  options.first_damping = 1e-8;
  options.is_smooth = true;
  Objective objective(input);
  result.termination = descend(objective, options, result.path);
  result.solve_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace sac
