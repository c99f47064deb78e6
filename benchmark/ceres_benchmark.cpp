/// The refinement by the solvers of Ceres, with the Jacobians of this package.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <ceres/ceres.h>

#include <benchmark/benchmark.h>

#include "cycle_scenarios.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"

namespace sac::benchmarks {
namespace {

constexpr double kParameterTolerance = 1e-12;

/// The coordinates as Ceres moves them. The model at them is worked out once for all residuals.
class SharedPoint final : public ceres::EvaluationCallback {
 public:
  SharedPoint(const ObservationEvaluator& evaluator, Eigen::VectorXd& x)
      : evaluator_(evaluator), x_(x) {}

  void PrepareForEvaluation(bool /*with_jacobians*/, bool is_new) override {
    if (is_new || !point_) {
      point_.emplace(evaluator_.at(x_));
    }
  }
  const ModelPoint& point() const { return *point_; }

 private:
  const ObservationEvaluator& evaluator_;
  const Eigen::VectorXd& x_;
  std::optional<ModelPoint> point_;
};

/// A block of coordinates that Ceres moves as one.
struct Block {
  Eigen::Index first = 0;
  Eigen::Index size = 0;
};

/// One observation, by the blocks that it depends on.
class ObservationCost final : public ceres::CostFunction {
 public:
  ObservationCost(const ObservationEvaluator& evaluator,
                  const SharedPoint& shared,
                  std::size_t observation,
                  std::vector<Block> blocks)
      : evaluator_(evaluator),
        shared_(shared),
        observation_(observation),
        blocks_(std::move(blocks)) {
    set_num_residuals(3);
    for (const Block& block : blocks_) {
      mutable_parameter_block_sizes()->push_back(static_cast<int>(block.size));
    }
  }

  bool Evaluate(double const* const* /*parameters*/,
                double* residuals,
                double** jacobians) const override {
    Eigen::Map<Eigen::Vector3d> residual(residuals);
    if (jacobians == nullptr) {
      residual = evaluator_.residual(observation_, shared_.point());
      return true;
    }
    evaluator_.linearize(observation_, shared_.point(), linear_);
    residual = linear_.residual;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (jacobians[b] != nullptr) {
        using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
        Eigen::Map<Rows>(jacobians[b], 3, blocks_[b].size) =
            linear_.jacobian.middleCols(blocks_[b].first, blocks_[b].size);
      }
    }
    return true;
  }

 private:
  const ObservationEvaluator& evaluator_;
  const SharedPoint& shared_;
  std::size_t observation_;
  std::vector<Block> blocks_;
  mutable LinearizedObservation linear_;  ///< one thread
};

/// Blocks of an observation: the joint, all poles, and the coils that it excites.
std::vector<Block> blocksOf(const ParameterSpace& space,
                            const ObservationEvaluator& evaluator,
                            const EstimationProblem& problem,
                            std::size_t observation) {
  std::vector<Block> blocks{{0, space.pole(0)}};
  if (problem.observations[observation].quantity == Quantity::kTorque) {
    blocks.push_back({space.pole(0), space.coil(0) - space.pole(0)});
    for (const Excitation& excitation : evaluator.excitations(observation)) {
      blocks.push_back({space.coil(excitation.coil), ParameterSpace::kPerAxis});
    }
  }
  return blocks;
}

ceres::Solver::Options solverOptions(ceres::LinearSolverType type) {
  ceres::Solver::Options options;
  options.linear_solver_type = type;
  options.num_threads = 1;
  options.initial_trust_region_radius = 1e8;  // close to Gauss-Newton from the first step, as ours
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = kParameterTolerance;
  options.logging_type = ceres::SILENT;
  return options;
}

/// The same problem, start and tolerance as iterate/refine.
void ceresRefine(benchmark::State& state, ceres::LinearSolverType type) {
  const CycleScenario scenario =
      cycleScenario(Cycle::kRefine, static_cast<std::size_t>(state.range(0)));
  const ParameterSpace& space = scenario.model.space();
  const EstimationProblem problem = problemOf(scenario);
  const EstimationOptions options;
  Eigen::VectorXd x;
  int iterations = 0;
  for (auto _ : state) {
    x = scenario.state.belief.x;
    const ObservationEvaluator evaluator(problem, options);
    SharedPoint shared(evaluator, x);
    ceres::Problem::Options problem_options;
    ceres::Solver::Options solver = solverOptions(type);
#if CERES_VERSION_MAJOR >= 2
    problem_options.evaluation_callback = &shared;
#else
    solver.evaluation_callback = &shared;
#endif
    ceres::Problem solved(problem_options);
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (std::size_t n = 0; n < problem.observations.size(); ++n) {
      std::vector<double*> places;
      const std::vector<Block> blocks = blocksOf(space, evaluator, problem, n);
      for (const Block& block : blocks) {
        places.push_back(x.data() + block.first);
        // Coils are eliminated first: no observation here sees two of them.
        solver.linear_solver_ordering->AddElementToGroup(places.back(),
                                                         block.first < space.coil(0) ? 1 : 0);
      }
      solved.AddResidualBlock(new ObservationCost(evaluator, shared, n, blocks), nullptr, places);
    }
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &solved, &summary);
    iterations = static_cast<int>(summary.iterations.size()) - 1;
    if (!summary.IsSolutionUsable()) {
      state.SkipWithError("Ceres found no solution");
    }
  }
  if (worstError(scenario, x) > kExact) {
    state.SkipWithError("the truth was not found");
  }
  state.counters["iterations"] = iterations;
}

constexpr int kSessionSamples = 132;

BENCHMARK_CAPTURE(ceresRefine, DENSE_QR, ceres::DENSE_QR)
    ->Arg(kSessionSamples)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ceresRefine, DENSE_NORMAL_CHOLESKY, ceres::DENSE_NORMAL_CHOLESKY)
    ->Arg(kSessionSamples)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ceresRefine, DENSE_SCHUR, ceres::DENSE_SCHUR)
    ->Arg(kSessionSamples)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ceresRefine, SPARSE_SCHUR, ceres::SPARSE_SCHUR)
    ->Arg(kSessionSamples)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ceresRefine, SPARSE_NORMAL_CHOLESKY, ceres::SPARSE_NORMAL_CHOLESKY)
    ->Arg(kSessionSamples)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sac::benchmarks
