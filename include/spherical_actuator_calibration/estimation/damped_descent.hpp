#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/termination.hpp"

namespace sac {

/// Cost, half its gradient and half its Gauss–Newton Hessian at one point, by steps from there.
struct NormalEquations {
  double cost = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;

  bool isFinite() const;
};

/// Nearly none.
constexpr double kLeastDamping = 1e-16;

/// The step that least squares ask for, with so much more information of each coordinate as a share
/// of its own; nothing: none is defined.
std::optional<Eigen::VectorXd> dampedStep(const NormalEquations& here,
                                          double damping = kLeastDamping);

/// How a descent goes and when it ends.
struct DescentOptions {
  int max_iterations = 50;
  /// Of the first step, as a share of each coordinate's own information.
  double first_damping = 1e-8;
  /// Whether the cost is smooth to its last digits, so that the model tells of short steps better
  /// than rounding lets the cost do: they are taken untried.
  bool is_smooth = false;
};

/// The steps of a descent by Levenberg and Marquardt: how much they are damped, which of them are
/// taken, and which is the last one.
class DampedSteps {
 public:
  explicit DampedSteps(const DescentOptions& options);

  /// From now on steps start here, where a length of `nothing` counts as none.
  void startAt(NormalEquations here, double nothing);
  /// The next step: damped more than the one before, if that was not taken. Nothing: no step leads
  /// on from here, or none that is longer than nothing, see isLast().
  std::optional<Eigen::VectorXd> next();
  /// Whether the step must be tried before it is taken. Where one was not taken, the next are short
  /// because they are damped, which does not make them safe.
  bool isTried() const { return trials_ > 1 || !isShort(); }
  /// Whether a step that leads to this cost is taken.
  bool takes(double cost);
  void take() { take(1.0); }
  /// Whether nothing worth a step is left to go after the one that was taken.
  /// Where none was taken: whether those that are left are as short as nothing.
  bool isLast() const { return is_last_; }

 private:
  bool isShort() const { return is_fine_ || (is_last_ && options_.is_smooth); }
  bool isFine() const;
  bool endsHere() const;
  void take(double gain);
  void raiseDamping();

  DescentOptions options_;
  NormalEquations here_;
  double nothing_ = 0.0;
  double damping_ = 0.0;
  double growth_ = 2.0;  ///< of the damping, at the next refusal
  int trials_ = 0;       ///< from here
  Eigen::VectorXd step_;
  double previous_length_ = 0.0;  ///< 0: there was no step
  bool is_fine_ = false;
  bool is_last_ = false;
};

/// Goes down from the last point of `path`, which grows by each point that was reached, by
/// Levenberg–Marquardt steps (Madsen, Nielsen, Tingleff 2004) until the next one would change
/// nothing. A problem has a `Point` and gives, at one of them,
/// - `normalEquations(point)`, in the coordinates of a step,
/// - `cost(point)`, the same cost; the normal equations there are asked for if the step is taken,
/// - `moved(point, step)`, where the step leads,
/// - `nothing(point)`, the length of a step that counts as nothing there.
/// Whatever ends it, the last point is the best one, but for the rounding of costs and for a step
/// as short as nothing. Ends by kNumericalFailure where costs are not finite, or no damping gives a
/// step.
template <typename Problem>
Termination descend(Problem& problem,
                    const DescentOptions& options,
                    std::vector<typename Problem::Point>& path) {
  DampedSteps steps(options);
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    NormalEquations here = problem.normalEquations(path.back());
    if (!here.isFinite()) {
      return Termination::kNumericalFailure;
    }
    steps.startAt(std::move(here), problem.nothing(path.back()));
    while (true) {
      const std::optional<Eigen::VectorXd> step = steps.next();
      if (!step) {
        return steps.isLast() ? Termination::kConverged : Termination::kNumericalFailure;
      }
      typename Problem::Point moved = problem.moved(path.back(), *step);
      if (!steps.isTried()) {
        steps.take();
      } else if (!steps.takes(problem.cost(moved))) {
        continue;
      }
      path.push_back(std::move(moved));
      break;
    }
    if (steps.isLast()) {
      return Termination::kConverged;
    }
  }
  return Termination::kIterationLimit;
}

}  // namespace sac
