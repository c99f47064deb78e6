#include "spherical_actuator_calibration/estimation/least_squares.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>

#include <ceres/ceres.h>

#include <boost/container/small_vector.hpp>

#include "accumulated_least_squares.hpp"
#include "spherical_actuator_calibration/estimation/cost_functions.hpp"

namespace sac {
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

/// Coordinates that the solver holds as one block.
struct CoordinateBlock {
  Eigen::Index first = 0;
  Eigen::Index size = 0;
};

/// Joints, poles, each coil, laboratory effects; without those that are empty, which would have the
/// address of the next one.
std::vector<CoordinateBlock> coordinateBlocks(const ParameterSpace& space) {
  std::vector<CoordinateBlock> blocks{{0, space.pole(0)},
                                      {space.pole(0), space.coil(0) - space.pole(0)}};
  for (std::size_t j = 0; j < space.coils(); ++j) {
    blocks.push_back({space.coil(j), ParameterSpace::kPerAxis});
  }
  blocks.push_back({space.effect(), space.effects().size()});
  const auto is_empty = [](const CoordinateBlock& block) { return block.size == 0; };
  blocks.erase(std::remove_if(blocks.begin(), blocks.end(), is_empty), blocks.end());
  return blocks;
}

/// Frees the free coordinates of one block and holds the others exactly.
void constrainBlock(ceres::Problem& problem,
                    double* data,
                    const CoordinateBlock& block,
                    const std::vector<bool>& free) {
  if (!problem.HasParameterBlock(data)) {
    return;
  }
  std::vector<int> held;
  for (Eigen::Index c = 0; c < block.size; ++c) {
    if (!free[static_cast<std::size_t>(block.first + c)]) {
      held.push_back(static_cast<int>(c));
    }
  }
  if (static_cast<Eigen::Index>(held.size()) == block.size) {
    problem.SetParameterBlockConstant(data);
  } else if (!held.empty()) {
    problem.SetManifold(data, new ceres::SubsetManifold(static_cast<int>(block.size), held));
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

/// Whitened deviation of directionsᵀ x from its prior, over the given blocks of x.
class LinearPriorCost final : public ceres::CostFunction {
 public:
  LinearPriorCost(const LinearPrior& prior,
                  const std::vector<Eigen::Index>& firsts,
                  const std::vector<Eigen::Index>& sizes)
      : firsts_(firsts) {
    const Eigen::MatrixXd lower = prior.covariance.llt().matrixL();
    const auto whiten = lower.triangularView<Eigen::Lower>();
    whitened_ = whiten.solve(prior.directions.transpose());
    mean_ = whiten.solve(prior.mean);
    set_num_residuals(static_cast<int>(mean_.size()));
    for (const Eigen::Index size : sizes) {
      mutable_parameter_block_sizes()->push_back(static_cast<int>(size));
    }
  }

  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd> residual(residuals, mean_.size());
    residual = -mean_;
    for (std::size_t b = 0; b < firsts_.size(); ++b) {
      const Eigen::Index size = parameter_block_sizes()[b];
      const auto block = whitened_.middleCols(firsts_[b], size);
      residual += block * Eigen::Map<const Eigen::VectorXd>(parameters[b], size);
      if (jacobians != nullptr && jacobians[b] != nullptr) {
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        Eigen::Map<RowMajor>(jacobians[b], mean_.size(), size) = block;
      }
    }
    return true;
  }

 private:
  std::vector<Eigen::Index> firsts_;
  Eigen::MatrixXd whitened_;  ///< d×P
  Eigen::VectorXd mean_;      ///< whitened, too
};

/// Adds the prior over the blocks that its directions reach.
void addPrior(const LeastSquaresInput& input,
              const std::vector<CoordinateBlock>& blocks,
              Eigen::VectorXd& x,
              ceres::Problem& problem) {
  const Eigen::MatrixXd& directions = input.prior.directions;
  if (directions.cols() == 0) {
    return;
  }
  std::vector<Eigen::Index> firsts;
  std::vector<Eigen::Index> sizes;
  std::vector<double*> reached;
  for (const CoordinateBlock& block : blocks) {
    if (!directions.middleRows(block.first, block.size).isZero(0.0)) {
      firsts.push_back(block.first);
      sizes.push_back(block.size);
      reached.push_back(x.data() + block.first);
    }
  }
  problem.AddResidualBlock(new LinearPriorCost(input.prior, firsts, sizes), nullptr, reached);
}

ceres::Solver::Options solverOptions(const LeastSquaresInput& input) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
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
  // Above this number the orthogonal factorisation costs more time and memory than it saves digits.
  constexpr std::ptrdiff_t kMostOrthogonal = 1000;
  if (std::count(input.active.begin(), input.active.end(), true) > kMostOrthogonal) {
    return solveAccumulatedLeastSquares(input);
  }
  const ParameterSpace& space = input.problem->model->space();
  LeastSquaresResult result;
  result.path.push_back(input.start);
  Eigen::VectorXd x = input.start;

  const std::unique_ptr<ceres::LossFunction> loss = makeLoss(input.loss, input.loss_transition);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  addObservations(input, loss.get(), x, problem);
  const std::vector<CoordinateBlock> blocks = coordinateBlocks(space);
  addPrior(input, blocks, x, problem);
  for (const CoordinateBlock& block : blocks) {
    constrainBlock(problem, x.data() + block.first, block, input.free);
  }

  PathRecorder recorder(x, result.path);
  ceres::Solver::Options options = solverOptions(input);
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

}  // namespace sac
