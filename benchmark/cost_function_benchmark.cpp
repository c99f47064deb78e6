#include <array>
#include <memory>

#include <benchmark/benchmark.h>

#include "cycle_scenarios.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"
#include "support/autodiff_costs.hpp"

namespace sac::benchmarks {
namespace {

constexpr std::size_t kCostSamples = 30;
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

/// The same of the model itself, by all coordinates. `evaluate(point, n, jacobian)` returns a
/// residual.
template <typename Evaluate>
void evaluateModel(benchmark::State& state,
                   const CycleScenario& scenario,
                   const Evaluate& evaluate) {
  ResidualJacobian jacobian;
  for (auto _ : state) {
    const ModelPoint point(scenario.model, scenario.state.belief.x);
    for (std::size_t n = 0; n < kCostSamples; ++n) {
      benchmark::DoNotOptimize(evaluate(point, n, jacobian));
      benchmark::DoNotOptimize(jacobian.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCostSamples));
}

void orientationAnalytic(benchmark::State& state) {
  const CycleScenario scenario = cycleScenario(Cycle::kJoint, kCostSamples);
  evaluateModel(
      state, scenario, [&](const ModelPoint& point, std::size_t n, ResidualJacobian& jacobian) {
        return point.orientationResidual(scenario.samples[n], &jacobian);
      });
}

void orientationAutodiff(benchmark::State& state) {
  const CycleScenario scenario = cycleScenario(Cycle::kJoint, kCostSamples);
  Costs costs;
  for (const Sample& sample : scenario.samples) {
    costs.push_back(std::make_unique<autodiff::OrientationCost>(
        new autodiff::OrientationResidual(scenario.model, sample, Eigen::Matrix3d::Identity())));
  }
  evaluateAll(state, costs, {scenario.state.belief.x.data()});
}

std::vector<std::vector<Excitation>> excitationsOf(const CycleScenario& scenario) {
  std::vector<std::vector<Excitation>> excitations;
  for (const Sample& sample : scenario.samples) {
    excitations.push_back(excitedCoils(sample, EstimationOptions().current_threshold));
  }
  return excitations;
}

void torqueAnalytic(benchmark::State& state) {
  const CycleScenario scenario = cycleScenario(Cycle::kPoles, kCostSamples);
  const std::vector<std::vector<Excitation>> excitations = excitationsOf(scenario);
  evaluateModel(
      state, scenario, [&](const ModelPoint& point, std::size_t n, ResidualJacobian& jacobian) {
        return point.torqueResidual(scenario.samples[n], excitations[n], &jacobian);
      });
}

void torqueAutodiff(benchmark::State& state) {
  const CycleScenario scenario = cycleScenario(Cycle::kPoles, kCostSamples);
  const ParameterSpace& space = scenario.model.space();
  const std::vector<std::vector<Excitation>> excitations = excitationsOf(scenario);
  Costs costs;
  for (std::size_t n = 0; n < scenario.samples.size(); ++n) {
    costs.push_back(std::make_unique<autodiff::TorqueCost<kPoles>>(new autodiff::TorqueResidual(
        scenario.model, scenario.samples[n], excitations[n].front(), Eigen::Matrix3d::Identity())));
  }
  const Eigen::VectorXd& x = scenario.state.belief.x;
  const std::size_t coil = excitations.front().front().coil;
  evaluateAll(state, costs, {x.data(), x.data() + space.pole(0), x.data() + space.coil(coil)});
}

/// What the names begin with.
void orientationCost(benchmark::State& state, void (*evaluate)(benchmark::State&)) {
  evaluate(state);
}
void torqueCost(benchmark::State& state, void (*evaluate)(benchmark::State&)) {
  evaluate(state);
}

BENCHMARK_CAPTURE(orientationCost, analytic, orientationAnalytic);
BENCHMARK_CAPTURE(orientationCost, autodiff, orientationAutodiff);
BENCHMARK_CAPTURE(torqueCost, analytic, torqueAnalytic);
BENCHMARK_CAPTURE(torqueCost, autodiff, torqueAutodiff);

}  // namespace
}  // namespace sac::benchmarks
