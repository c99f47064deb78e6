#include <benchmark/benchmark.h>

#include "cycle_scenarios.hpp"
#include "spherical_actuator_calibration/estimation/incremental_estimate.hpp"

namespace sac::benchmarks {
namespace {

/// One more sample of a session, and what all of them tell after it.
void takeOneSample(benchmark::State& state) {
  const CycleScenario scenario =
      cycleScenario(Cycle::kRefine, static_cast<std::size_t>(state.range(0)));
  IncrementalEstimate estimate(scenario.model, scenario.state.belief, {});
  std::size_t next = 0;
  for (auto _ : state) {
    estimate.add(scenario.samples[next]);
    benchmark::DoNotOptimize(estimate.belief());
    next = (next + 1) % scenario.samples.size();
  }
  state.counters["parameters"] = static_cast<double>(scenario.model.space().size());
}

BENCHMARK(takeOneSample)->Arg(132)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sac::benchmarks
