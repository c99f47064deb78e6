#pragma once

#include <limits>
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

/// The step that least squares ask for, with so much more information of each coordinate as a share
/// of its own; nothing: none is defined.
std::optional<Eigen::VectorXd> dampedStep(const NormalEquations& here, double damping);

/// How a descent goes and when it ends.
struct DescentOptions {
  int max_iterations = 50;
  /// Of the first step, as a share of each coordinate's own information.
  double first_damping = 1e-8;
  double longest_step = std::numeric_limits<double>::infinity();
  /// Steps shorter than so many times what counts as nothing are taken untried: where the cost is
  /// smooth to its last digits, rounding would judge them.
  double untried_length = 1.0;
};

/// The steps of a descent by Levenberg and Marquardt: how much they are damped, which of them are
/// taken, and which is the last one.
class DampedSteps {
 public:
  explicit DampedSteps(const DescentOptions& options);

  /// From now on steps start here, where a length of `nothing` counts as none.
  void startAt(NormalEquations here, double nothing);
  /// The next step to try: damped more than the one before, if that was not taken. Nothing: no
  /// damping helps.
  std::optional<Eigen::VectorXd> next();
  /// Whether the step must be tried before it is taken.
  bool isTried() const { return !is_fine_ && !is_last_; }
  /// Whether a step that leads to this cost is taken.
  bool takes(double cost);
  void take() { take(1.0); }
  /// Whether nothing worth a step is left to go after the one that was taken.
  bool isLast() const { return is_last_; }

 private:
  bool isFine() const;
  bool endsHere() const;
  void take(double gain);
  void raiseDamping();

  DescentOptions options_;
  NormalEquations here_;
  double nothing_ = 0.0;
  double damping_ = 0.0;
  double growth_ = 2.0;  ///< of the damping, at the next refusal
  bool is_refused_ = false;
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
/// Ends by kNumericalFailure where costs are not finite or no damping gives a step: the last point
/// is the best one then, too.
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
        return Termination::kNumericalFailure;
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
