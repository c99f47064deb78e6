#include <algorithm>
#include <cstdint>

#include <benchmark/benchmark.h>

#include "cycle_scenarios.hpp"
#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/assessment/torque_linearity.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/session_guidance.hpp"
#include "spherical_actuator_calibration/calibration/session_progress.hpp"
#include "spherical_actuator_calibration/estimation/least_squares.hpp"
#include "spherical_actuator_calibration/planning/plan_guidance.hpp"
#include "support/resident_memory.hpp"

namespace sac::benchmarks {
namespace {

void tell(benchmark::State& state,
          const CycleScenario& scenario,
          bool success,
          std::size_t iterations,
          const Eigen::VectorXd& x) {
  const double error = worstError(scenario, x);
  if (!success || error > kExact) {
    state.SkipWithError("the truth was not found");
  }
  state.counters["iterations"] = static_cast<double>(iterations);
  state.counters["worst_error"] = error;
}

/// A cycle's iteration alone, from the nominal parameters to convergence: what the paper describes.
void iterate(benchmark::State& state, Cycle cycle) {
  const CycleScenario scenario = cycleScenario(cycle, static_cast<std::size_t>(state.range(0)));
  const ParameterSpace& space = scenario.model.space();
  const EstimationProblem problem = problemOf(scenario);
  const EstimationOptions options;
  LeastSquaresInput input;
  input.active.assign(problem.observations.size(), true);
  input.free = selectCoordinates(space, scenario.samples, scenario.request, options);
  input.start = scenario.state.belief.x;
  const std::vector<Whitening> whitening(problem.observations.size(),
                                         Whitening(Eigen::Matrix3d::Identity()));
  input.whitening = &whitening;

  LeastSquaresResult result;
  for (auto _ : state) {
    const ObservationEvaluator evaluator(problem, options);
    input.evaluator = &evaluator;
    result = solveLeastSquares(input);
  }
  tell(state,
       scenario,
       result.termination == Termination::kConverged,
       result.path.size() - 1,
       result.solution());
}

/// A whole cycle as an operator asks for it: weights, iteration, outlier test, observability,
/// covariance, uncertainty over the workspace, report.
void runWholeCycle(benchmark::State& state, const CycleScenario& scenario) {
  CycleOutcome outcome;
  const auto run = [&] {
    outcome = runCycle(scenario.model, scenario.samples, scenario.state, scenario.request, {});
  };
  run();  // brings the program into memory, too
  state.counters["bytes_a_sample"] = peakBeside(run) / static_cast<double>(scenario.samples.size());
  for (auto _ : state) {
    run();
  }
  tell(state, scenario, outcome.report.success, outcome.report.iterations, outcome.state.belief.x);
}

void runWholeCycle(benchmark::State& state, Cycle cycle) {
  runWholeCycle(state, cycleScenario(cycle, static_cast<std::size_t>(state.range(0))));
}

/// The same by the number of coils, at a number of samples that stays.
void refineManyCoils(benchmark::State& state) {
  constexpr std::size_t kSamples = 4000;
  runWholeCycle(state, manyCoilsScenario(static_cast<std::size_t>(state.range(0)), kSamples));
}

/// What the status of a session tells after a capture: what is counted, the next step, that of a
/// plan with a pose for every six samples, and whether torque is proportional to current.
void statusManyCoils(benchmark::State& state) {
  constexpr std::size_t kSamples = 4000;
  constexpr std::size_t kSamplesPerPose = 6;
  const CycleScenario scenario =
      manyCoilsScenario(static_cast<std::size_t>(state.range(0)), kSamples);
  const ParameterSpace& space = scenario.model.space();
  const EstimationOptions options;
  CalibrationState reached = scenario.state;
  std::fill_n(reached.identified.begin(), space.pole(0), true);
  ProgressCounter counter(scenario.model, reached, options);
  LinearitySearch linearity(options);
  PlanProgress plan(options.current_threshold);
  for (std::size_t n = 0; n < scenario.samples.size(); n += kSamplesPerPose) {
    plan.addPose({scenario.samples[n].joint_position, {}});
  }
  const auto add = [&](const Sample& sample) {
    counter.add(sample);
    linearity.add(sample);
    plan.add(sample);
  };
  std::for_each(scenario.samples.begin(), scenario.samples.end(), add);
  std::size_t next = 0;
  for (auto _ : state) {
    add(scenario.samples[next]);
    next = (next + 1) % scenario.samples.size();
    SessionProgress progress = counter.progress();
    progress.plan_step = plan.nextStep();
    benchmark::DoNotOptimize(nextStep(scenario.model, progress));
    benchmark::DoNotOptimize(describe(linearity.best()));
  }
}

/// What a sample that is held out tells of the grade, beside 4000 in use and 100 to 200 that are
/// held out, of all coils.
void gradeManyCoils(benchmark::State& state) {
  constexpr std::size_t kSamples = 4000;
  constexpr std::size_t kHeldOut = 100;
  constexpr std::size_t kBetween = 19;
  const CycleScenario scenario =
      manyCoilsScenario(static_cast<std::size_t>(state.range(0)), kSamples);
  CalibrationSession refined({scenario.model.space().nominal()}, scenario.samples, {});
  refined.run({Cycle::kRefine});
  std::vector<Sample> held_out;
  for (std::size_t n = 0; held_out.size() < 2 * kHeldOut; n += kBetween) {
    held_out.push_back(scenario.samples[n]);
    held_out.back().validation = true;
  }
  std::optional<CalibrationSession> session;
  std::optional<CalibrationGrader> grader;
  std::size_t next = held_out.size();
  GradedCalibration graded;
  for (auto _ : state) {
    if (next == held_out.size()) {
      state.PauseTiming();
      session.emplace(refined);
      grader.emplace(*session);
      std::for_each_n(held_out.begin(), kHeldOut, [&](const Sample& one) { session->add(one); });
      next = kHeldOut;
      grader->grade();
      state.ResumeTiming();
    }
    state.PauseTiming();
    grader->settle();
    state.ResumeTiming();
    session->add(held_out[next++]);
    graded = grader->grade();
  }
  state.SetLabel(gradeName(graded.grade));
}

constexpr int kMany = 100000;

BENCHMARK_CAPTURE(iterate, joint, Cycle::kJoint)->Arg(30)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(iterate, poles, Cycle::kPoles)->Arg(30)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(iterate, coil, Cycle::kCoil)->Arg(4)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(iterate, refine, Cycle::kRefine)->Arg(132)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(runWholeCycle, refine, Cycle::kRefine)
    ->Arg(132)
    ->RangeMultiplier(10)
    ->Range(100, std::int64_t{10} * kMany)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(refineManyCoils)
    ->Arg(24)
    ->Arg(48)
    ->Arg(96)
    ->Arg(200)
    ->Arg(400)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(statusManyCoils)->Arg(24)->Arg(400)->Unit(benchmark::kMicrosecond);
BENCHMARK(gradeManyCoils)->Arg(24)->Arg(400)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(runWholeCycle, joint, Cycle::kJoint)
    ->Arg(30)
    ->Arg(kMany)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(runWholeCycle, poles, Cycle::kPoles)
    ->Arg(30)
    ->Arg(kMany)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(runWholeCycle, coil, Cycle::kCoil)
    ->Arg(4)
    ->Arg(kMany)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sac::benchmarks
