#include <benchmark/benchmark.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"
#include "support/scenarios.hpp"

namespace sac::benchmarks {
namespace {

constexpr Stamp kCycle = 1000000;  // [ns]
constexpr double kAmple = 2.5;     // [A]
constexpr double kTight = 1e-3;    // [A] less than the wanted torque takes

/// One cycle of control: reading, reference, torque, currents.
void controlCycle(benchmark::State& state, double current_limit) {
  OrientationControllerOptions options;
  options.allocation.current_limit = current_limit;
  options.rotor.unbalance = Eigen::Vector3d(0.0, 8.8e-3, 0.0);
  OrientationController controller(scenarios::paperNominal(), options);
  controller.setParameters(scenarios::paperTruth());
  const Eigen::Vector3d q(0.2, -0.1, 0.5);
  Stamp now = 0;
  controller.receive({now, q});
  controller.enable(now);
  controller.setTarget(now, rotationExp({0.25, -0.1, 0.6}));
  for (auto _ : state) {
    now += kCycle;
    controller.receive({now, q});
    benchmark::DoNotOptimize(controller.update(now));
  }
  if (controller.state() != ControlState::kActive ||
      (controller.torqueShare() < 1.0) != (current_limit < kAmple)) {
    state.SkipWithError("the control was not in the state to be measured");
  }
}

BENCHMARK_CAPTURE(controlCycle, within_limits, kAmple);
BENCHMARK_CAPTURE(controlCycle, at_the_limits, kTight);

}  // namespace
}  // namespace sac::benchmarks
