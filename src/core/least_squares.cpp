#include "spherical_actuator_calibration/core/least_squares.hpp"

#include <memory>

#include <ceres/ceres.h>

#include <boost/container/small_vector.hpp>

#include "spherical_actuator_calibration/core/cost_functions.hpp"

namespace spherical_actuator_calibration {
namespace {

/// Keeps the coordinates after every accepted iteration.
class PathRecorder final : public ceres::IterationCallback {
 public:
  PathRecorder(const Eigen::VectorXd& x, std::vector<Eigen::VectorXd>& path) : x_(x), path_(path) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (summary.iteration > 0 && summary.step_is_successful) {
      path_.push_back(x_);
    }
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const Eigen::VectorXd& x_;
  std::vector<Eigen::VectorXd>& path_;
};

std::unique_ptr<ceres::LossFunction> makeLoss(Loss loss, double transition) {
  switch (loss) {
    case Loss::kHuber:
      return std::make_unique<ceres::HuberLoss>(transition);
    case Loss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(transition);
    case Loss::kSquared:
      break;
  }
  return nullptr;
}

/// Frees the free coordinates of one block and holds the others exactly.
void constrainBlock(ceres::Problem& problem,
                    double* block,
                    Eigen::Index first,
                    Eigen::Index size,
                    const std::vector<bool>& free) {
  if (!problem.HasParameterBlock(block)) {
    return;
  }
  std::vector<int> held;
  for (Eigen::Index c = 0; c < size; ++c) {
    if (!free[static_cast<std::size_t>(first + c)]) {
      held.push_back(static_cast<int>(c));
    }
  }
  if (static_cast<Eigen::Index>(held.size()) == size) {
    problem.SetParameterBlockConstant(block);
  } else if (!held.empty()) {
    problem.SetManifold(block, new ceres::SubsetManifold(static_cast<int>(size), held));
  }
}

void addObservations(const LeastSquaresInput& input,
                     ceres::LossFunction* loss,
                     Eigen::VectorXd& x,
                     ceres::Problem& problem) {
  const CalibrationModel& model = *input.problem->model;
  const ParameterSpace& space = model.space();
  for (std::size_t n = 0; n < input.problem->observations.size(); ++n) {
    if (!input.active[n]) {
      continue;
    }
    const Observation& what = input.problem->observations[n];
    const Sample& sample = (*input.problem->samples)[what.sample];
    double* const effects = x.data() + space.effect();
    const bool has_effects = space.effects().size() > 0;
    if (what.quantity == Quantity::kOrientation) {
      std::vector<double*> blocks{x.data()};
      if (has_effects) {
        blocks.push_back(effects);
      }
      problem.AddResidualBlock(
          new OrientationCost(model, sample, (*input.whitening)[n]), loss, blocks);
      continue;
    }
    const std::vector<Excitation>& excitations = input.evaluator->excitations(n);
    boost::container::small_vector<double*, 8> blocks{x.data(), x.data() + space.pole(0)};
    for (const Excitation& excitation : excitations) {
      blocks.push_back(x.data() + space.coil(excitation.coil));
    }
    if (has_effects) {
      blocks.push_back(effects);
    }
    problem.AddResidualBlock(new TorqueCost(model, sample, excitations, (*input.whitening)[n]),
                             loss,
                             blocks.data(),
                             static_cast<int>(blocks.size()));
  }
}

ceres::Solver::Options solverOptions(const LeastSquaresInput& input, int residuals) {
  // Above this many rows the orthogonal factorisation costs more time than it saves digits.
  constexpr int kLargestOrthogonal = 3000;
  ceres::Solver::Options options;
  options.linear_solver_type =
      residuals > kLargestOrthogonal ? ceres::DENSE_NORMAL_CHOLESKY : ceres::DENSE_QR;
  options.max_num_iterations = input.max_iterations;
  // Close to Gauss–Newton from the first step: the prior lies within the basin as a rule, and the
  // trust region shrinks by itself where it does not.
  options.initial_trust_region_radius = 1e8;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = input.parameter_tolerance;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.update_state_every_iteration = true;
  return options;
}

}  // namespace

LeastSquaresResult solveLeastSquares(const LeastSquaresInput& input) {
  const ParameterSpace& space = input.problem->model->space();
  LeastSquaresResult result;
  result.path.push_back(input.start);
  Eigen::VectorXd x = input.start;

  const std::unique_ptr<ceres::LossFunction> loss = makeLoss(input.loss, input.loss_transition);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  addObservations(input, loss.get(), x, problem);
  constrainBlock(problem, x.data(), 0, space.pole(0), input.free);
  constrainBlock(
      problem, x.data() + space.pole(0), space.pole(0), space.coil(0) - space.pole(0), input.free);
  for (std::size_t j = 0; j < space.coils(); ++j) {
    const Eigen::Index first = space.coil(j);
    constrainBlock(problem, x.data() + first, first, ParameterSpace::kPerAxis, input.free);
  }
  constrainBlock(
      problem, x.data() + space.effect(), space.effect(), space.effects().size(), input.free);

  PathRecorder recorder(x, result.path);
  ceres::Solver::Options options = solverOptions(input, problem.NumResiduals());
  options.callbacks.push_back(&recorder);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  if (x != result.path.back()) {
    result.path.push_back(x);
  }
  result.solve_time = summary.total_time_in_seconds;
  if (summary.termination_type == ceres::CONVERGENCE) {
    result.termination = Termination::kConverged;
  } else if (summary.termination_type == ceres::NO_CONVERGENCE) {
    result.termination = Termination::kIterationLimit;
  }
  return result;
}

}  // namespace spherical_actuator_calibration
