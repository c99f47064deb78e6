#include <benchmark/benchmark.h>

#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"
#include "support/scenarios.hpp"

namespace sac::benchmarks {
namespace {

/// 20 orientations and 160 torques of single coils.
std::vector<Sample> measuredSession() {
  scenarios::Generator generator(1);
  const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.03, generator);
  std::vector<Sample> samples = scenarios::orientationSamples(
      truth, scenarios::randomPoses(20, 0.5, generator), 1e-3, 5.8e-4, generator);
  for (std::size_t n = 0; n < 160; ++n) {
    const std::vector<Sample> one =
        scenarios::torqueSamples(truth,
                                 scenarios::randomPoses(1, 0.5, generator),
                                 n % truth.coils.size(),
                                 2.0,
                                 5e-4,
                                 2.9e-4,
                                 generator);
    samples.push_back(one.front());
  }
  return samples;
}

void diagnoseHealthy(benchmark::State& state) {
  const std::vector<Sample> samples = measuredSession();
  for (auto _ : state) {
    benchmark::DoNotOptimize(diagnoseWiring(scenarios::paperNominal(), samples, {}));
  }
}

void diagnoseSwappedCoils(benchmark::State& state) {
  std::vector<Sample> samples = measuredSession();
  for (Sample& sample : samples) {
    sample.joint_position[0] *= -1.0;
    if (sample.current.size() > 0) {
      std::swap(sample.current[1], sample.current[4]);
    }
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(diagnoseWiring(scenarios::paperNominal(), samples, {}));
  }
}

BENCHMARK(diagnoseHealthy)->Unit(benchmark::kMillisecond);
BENCHMARK(diagnoseSwappedCoils)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sac::benchmarks
