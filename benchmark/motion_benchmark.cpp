#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/motion/live_motion.hpp"
#include "support/motion_slices.hpp"
#include "support/moving_rotor.hpp"
#include "support/resident_memory.hpp"

namespace sac::benchmarks {
namespace {

constexpr double kRightEnough = 1e-3;  ///< of what noisy motion tells [rad]

MovingRotor movingUnit(double duration) {
  scenarios::Generator generator(3);
  MovingRotor moving;
  moving.truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
  moving.rotor.inertia(0, 0) *= 1.1;
  moving.rotor.unbalance = Eigen::Vector3d(1e-3, -5e-4, 2e-3);
  moving.duration = duration;
  moving.current_delay = 3e-3;
  moving.tracker_delay = 5e-3;
  return moving;
}

/// One more window of a motion that has gone on for a minute, as it comes: what all of them tell
/// after it, with its covariance. What looks at old windows now and then is part of it.
void takeOneWindow(benchmark::State& state) {
  constexpr std::size_t kMinute = 240;
  const std::vector<MotionSlice> slices = slicesOf(noisy(movingUnit(15.0).record()).spans.front());
  const CalibrationModel model(
      ParameterSpace(scenarios::paperNominal(), withMotionEffects(EffectSelection())));
  std::vector<Eigen::Index> free(static_cast<std::size_t>(model.space().size()));
  std::iota(free.begin(), free.end(), 0);
  LiveMotion live(model, nominalState(model.space(), {}).belief, free, EstimationOptions());
  std::size_t next = 0;
  const auto take = [&] { live.add(slices[next++ % slices.size()]); };
  while (next < kMinute) {
    take();
  }
  for (auto _ : state) {
    take();
  }
  if (!live.estimate().is_told || live.estimate().left_out > 0) {
    state.SkipWithError("nothing was found");
  }
  state.counters["parameters"] = static_cast<double>(model.space().size());
}

/// The whole cycle `motion` of so many seconds, as calibrate_bag runs it: from the drawing to
/// parameters, verdict and report.
void calibrateMotion(benchmark::State& state) {
  const auto seconds = static_cast<double>(state.range(0));
  const MovingRotor moving = movingUnit(seconds);
  const auto recording = std::make_shared<const MotionRecording>(noisy(moving.record()));
  CalibrationConfig config;
  config.effects = withMotionEffects(config.effects);
  CycleReport report;
  double worst = 0.0;
  const auto run = [&] {
    CalibrationSession session({scenarios::paperNominal()}, {}, config);
    session.setMotion(recording);
    report = session.run({Cycle::kMotion});
    const ParameterSpace& space = session.model().space();
    const Eigen::VectorXd apart = session.state().belief.x - space.coordinatesOf(moving.truth);
    worst = apart.head(space.effect()).cwiseAbs().maxCoeff();
  };
  run();  // brings the program into memory, too
  state.counters["bytes_a_second"] = peakBeside(run) / seconds;
  for (auto _ : state) {
    run();
  }
  if (!report.success || worst > kRightEnough) {
    state.SkipWithError("the truth was not found");
  }
  state.counters["iterations"] = static_cast<double>(report.iterations);
  state.counters["worst_error"] = worst;
}

BENCHMARK(takeOneWindow)->Unit(benchmark::kMicrosecond);
BENCHMARK(calibrateMotion)
    ->Arg(15)
    ->Arg(60)
    ->Arg(240)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sac::benchmarks
