#include <array>
#include <memory>

#include <benchmark/benchmark.h>

#include "cycle_scenarios.hpp"
#include "support/autodiff_costs.hpp"
#include "support/ceres_costs.hpp"

namespace sac::benchmarks {
namespace {

constexpr std::size_t kSamples = 30;
constexpr int kPoles = 8;

using Costs = std::vector<std::unique_ptr<ceres::CostFunction>>;

/// Residuals and Jacobians by all blocks of all costs once, as one iteration of a solver asks for
/// them.
void evaluateAll(benchmark::State& state,
                 const Costs& costs,
                 const std::vector<const double*>& blocks) {
  std::array<double, 3> residual{};
  std::array<Eigen::Matrix<double, 3, 2 * kPoles>, 3> storage;
  std::vector<double*> jacobians;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    jacobians.push_back(storage[b].data());
  }
  for (auto _ : state) {
    for (const auto& cost : costs) {
      cost->Evaluate(blocks.data(), residual.data(), jacobians.data());
      benchmark::DoNotOptimize(residual);
      benchmark::DoNotOptimize(storage);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(costs.size()));
}

enum class Derivative { kAnalytic, kAutodiff };

void orientationCost(benchmark::State& state, Derivative derivative) {
  const CycleScenario scenario = cycleScenario(Cycle::kJoint, kSamples);
  const Eigen::Matrix3d whitening = Eigen::Matrix3d::Identity();
  Costs costs;
  for (const Sample& sample : scenario.samples) {
    if (derivative == Derivative::kAnalytic) {
      costs.push_back(std::make_unique<OrientationCost>(scenario.model, sample, whitening));
    } else {
      costs.push_back(std::make_unique<autodiff::OrientationCost>(
          new autodiff::OrientationResidual(scenario.model, sample, whitening)));
    }
  }
  evaluateAll(state, costs, {scenario.state.belief.x.data()});
}

void torqueCost(benchmark::State& state, Derivative derivative) {
  const CycleScenario scenario = cycleScenario(Cycle::kPoles, kSamples);
  const ParameterSpace& space = scenario.model.space();
  const std::size_t coil = scenario.request.coil.value();
  const Eigen::Matrix3d whitening = Eigen::Matrix3d::Identity();
  std::vector<std::vector<Excitation>> excitations;
  for (const Sample& sample : scenario.samples) {
    excitations.push_back(excitedCoils(sample, EstimationOptions().current_threshold));
  }
  Costs costs;
  for (std::size_t n = 0; n < scenario.samples.size(); ++n) {
    if (derivative == Derivative::kAnalytic) {
      costs.push_back(std::make_unique<TorqueCost>(
          scenario.model, scenario.samples[n], excitations[n], whitening));
    } else {
      costs.push_back(std::make_unique<autodiff::TorqueCost<kPoles>>(new autodiff::TorqueResidual(
          scenario.model, scenario.samples[n], excitations[n].front(), whitening)));
    }
  }
  const Eigen::VectorXd& x = scenario.state.belief.x;
  evaluateAll(state, costs, {x.data(), x.data() + space.pole(0), x.data() + space.coil(coil)});
}

BENCHMARK_CAPTURE(orientationCost, analytic, Derivative::kAnalytic);
BENCHMARK_CAPTURE(orientationCost, autodiff, Derivative::kAutodiff);
BENCHMARK_CAPTURE(torqueCost, analytic, Derivative::kAnalytic);
BENCHMARK_CAPTURE(torqueCost, autodiff, Derivative::kAutodiff);

}  // namespace
}  // namespace sac::benchmarks
