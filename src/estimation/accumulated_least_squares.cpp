#include "accumulated_least_squares.hpp"

#include <chrono>
#include <cmath>

#include <Eigen/Cholesky>

#include <boost/container/small_vector.hpp>

namespace sac {
namespace {

constexpr double kLeastDamping = 1e-16;
constexpr double kFirstDamping = 1e-8;  // close to Gauss–Newton, as in solveLeastSquares()
constexpr double kLargestDamping = 1e8;
constexpr double kCostTolerance = 1e-15;

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

/// Sums over the active observations at one point, for the free coordinates.
struct Sums {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  double cost = 0.0;
};

class Accumulation {
 public:
  explicit Accumulation(const LeastSquaresInput& input) : input_(input) {
    for (std::size_t p = 0; p < input.free.size(); ++p) {
      slots_.push_back(input.free[p] ? static_cast<Eigen::Index>(free_.size()) : -1);
      if (input.free[p]) {
        free_.push_back(static_cast<Eigen::Index>(p));
      }
    }
    if (input.prior.directions.cols() > 0) {
      const Eigen::MatrixXd lower = input.prior.covariance.llt().matrixL();
      const auto whiten = lower.triangularView<Eigen::Lower>();
      prior_ = whiten.solve(input.prior.directions.transpose());
      prior_mean_ = whiten.solve(input.prior.mean);
    }
  }

  double cost(const Eigen::VectorXd& x) const {
    double cost = priorResidual(x).squaredNorm();
    for (std::size_t n = 0; n < input_.active.size(); ++n) {
      if (input_.active[n]) {
        const double s = ((*input_.whitening)[n] * input_.evaluator->residual(n, x)).squaredNorm();
        cost += lossAt(input_.loss, input_.loss_transition, s).value;
      }
    }
    return cost;
  }

  Sums linearized(const Eigen::VectorXd& x) const {
    const auto count = static_cast<Eigen::Index>(free_.size());
    Sums sums{Eigen::MatrixXd::Zero(count, count), Eigen::VectorXd::Zero(count), 0.0};
    if (prior_.rows() > 0) {
      const Eigen::MatrixXd jacobian = prior_(Eigen::all, free_);
      sums.information = jacobian.transpose() * jacobian;
      sums.gradient = jacobian.transpose() * priorResidual(x);
      sums.cost = priorResidual(x).squaredNorm();
    }
    LinearizedObservation linear;
    for (std::size_t n = 0; n < input_.active.size(); ++n) {
      if (input_.active[n]) {
        input_.evaluator->linearize(n, x, linear);
        add(linear, (*input_.whitening)[n], sums);
      }
    }
    return sums;
  }

  Eigen::VectorXd moved(const Eigen::VectorXd& x, const Eigen::VectorXd& step) const {
    Eigen::VectorXd result = x;
    result(free_) += step;
    return result;
  }

 private:
  Eigen::VectorXd priorResidual(const Eigen::VectorXd& x) const {
    return prior_.rows() > 0 ? (prior_ * x - prior_mean_).eval() : Eigen::VectorXd();
  }

  void add(const LinearizedObservation& linear,
           const Eigen::Matrix3d& whitening,
           Sums& sums) const {
    const Eigen::Vector3d residual = whitening * linear.residual;
    const LossValue loss = lossAt(input_.loss, input_.loss_transition, residual.squaredNorm());
    sums.cost += loss.value;
    // Most poles are out of reach of a coil: their columns are zero.
    boost::container::small_vector<Eigen::Index, 32> slots;
    boost::container::small_vector<Eigen::Vector3d, 32> columns;
    for (const Eigen::Index p : linear.columns) {
      const Eigen::Index slot = slots_[static_cast<std::size_t>(p)];
      if (slot >= 0 && !linear.jacobian.col(p).isZero(0.0)) {
        slots.push_back(slot);
        columns.emplace_back(whitening * linear.jacobian.col(p));
      }
    }
    for (std::size_t a = 0; a < slots.size(); ++a) {
      sums.gradient[slots[a]] += loss.weight * columns[a].dot(residual);
      for (std::size_t b = 0; b < slots.size(); ++b) {
        sums.information(slots[a], slots[b]) += loss.weight * columns[a].dot(columns[b]);
      }
    }
  }

  const LeastSquaresInput& input_;
  std::vector<Eigen::Index> free_;
  std::vector<Eigen::Index> slots_;  ///< of each coordinate among the free ones, or −1
  Eigen::MatrixXd prior_;            ///< whitened directions, d×P
  Eigen::VectorXd prior_mean_;       ///< whitened
};

/// Levenberg–Marquardt steps from one point to a better one.
class Descent {
 public:
  Descent(const LeastSquaresInput& input, LeastSquaresResult& result)
      : input_(input), result_(result), accumulation_(input) {}

  Termination run() {
    for (int iteration = 0; iteration < input_.max_iterations; ++iteration) {
      const Sums sums = accumulation_.linearized(result_.path.back());
      if (!sums.information.allFinite() || !std::isfinite(sums.cost)) {
        return Termination::kNumericalFailure;
      }
      if (!improve(sums)) {
        return Termination::kNumericalFailure;
      }
      if (converged_) {
        return Termination::kConverged;
      }
    }
    return Termination::kIterationLimit;
  }

 private:
  /// Takes the first step that lowers the cost; false when there is none though the gradient asks.
  bool improve(const Sums& sums) {
    const Eigen::VectorXd& x = result_.path.back();
    for (; damping_ <= kLargestDamping; damping_ *= 10.0) {
      Eigen::MatrixXd damped = sums.information;
      damped.diagonal() *= 1.0 + damping_;
      const Eigen::LLT<Eigen::MatrixXd> factor(damped);
      if (factor.info() != Eigen::Success) {
        continue;
      }
      const Eigen::VectorXd step = -factor.solve(sums.gradient);
      const bool is_small =
          step.norm() <= input_.parameter_tolerance * (x.norm() + input_.parameter_tolerance);
      const Eigen::VectorXd moved = accumulation_.moved(x, step);
      const double cost = accumulation_.cost(moved);
      converged_ = is_small || std::abs(cost - sums.cost) <= kCostTolerance * sums.cost;
      if (cost <= sums.cost) {
        result_.path.push_back(moved);
        damping_ = std::max(0.1 * damping_, kLeastDamping);
        return true;
      }
      if (converged_) {
        return true;
      }
    }
    return false;
  }

  const LeastSquaresInput& input_;
  LeastSquaresResult& result_;
  Accumulation accumulation_;
  double damping_ = kFirstDamping;
  bool converged_ = false;
};

}  // namespace

LeastSquaresResult solveAccumulatedLeastSquares(const LeastSquaresInput& input) {
  const auto begin = std::chrono::steady_clock::now();
  LeastSquaresResult result;
  result.path.push_back(input.start);
  result.termination = Descent(input, result).run();
  result.solve_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace sac
