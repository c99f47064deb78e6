#include <cmath>
#include <memory>
#include <random>

#include <Eigen/Cholesky>

#include <benchmark/benchmark.h>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
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

/// Streams of 24 coils and of joints at 1 kHz and of a tracker at 250 Hz, with the noise of good
/// sensors.
MotionRecording noisyMotion(const MovingRotor& moving) {
  MotionRecording recording = moving.record();
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  const auto noise = [&](double stddev) -> Eigen::Vector3d {
    return stddev * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
  };
  for (MotionStreams& streams : recording.spans) {
    for (Eigen::Vector3d& reading : streams.joints) {
      reading += noise(2e-5);
    }
    for (Eigen::Index n = 0; n < streams.currents.size(); ++n) {
      streams.currents.data()[n] += static_cast<float>(1e-3 * normal(generator));
    }
    for (Eigen::Quaterniond& orientation : streams.orientations) {
      orientation = Eigen::Quaterniond(rotationExp(noise(5e-4))) * orientation;
    }
  }
  return recording;
}

/// One more window of a motion, as it comes: linearised where the estimate is, with the noise of
/// its residuals, and what all of them tell after it, with its covariance.
void takeOneWindow(benchmark::State& state) {
  constexpr double kCurrentStddev = 1e-3;  // [A]
  const MotionRecording recording = noisyMotion(movingUnit(6.0));
  const CalibrationModel model(
      ParameterSpace(scenarios::paperNominal(), withMotionEffects(EffectSelection())));
  const ParameterBelief prior = nominalState(model.space(), {}).belief;
  const MotionPlaces places(model.space());
  const MotionOptions options;
  const std::vector<MotionSpan> spans(1, MotionSpan(recording.spans.front()));
  std::vector<WindowsLeftOut> left_out;
  const std::vector<MotionWindow> windows = cutWindows(spans, options, left_out);
  BalanceEvaluator evaluator(options, Eigen::Vector3d::Constant(2e-5));
  WindowBalance balance;
  InformationSum sum(Eigen::MatrixXd(prior.covariance.diagonal().cwiseInverse().asDiagonal()));
  Eigen::MatrixXd covariance;
  Eigen::VectorXd x;
  std::size_t next = 0;
  for (auto _ : state) {
    const MotionPoint point(model, places, prior.x);
    evaluator.evaluate(spans.front(), windows[next], point, {true, 1}, balance);
    const Eigen::MatrixXd whitening =
        whiteningOfMany(balance.by_joints + kCurrentStddev * kCurrentStddev * balance.by_currents);
    const auto W = whitening.triangularView<Eigen::Lower>();
    sum.addDense(W * balance.jacobian, W * balance.residual);
    const Eigen::LLT<Eigen::MatrixXd> factor(sum.information());
    covariance = factor.solve(Eigen::MatrixXd::Identity(prior.x.size(), prior.x.size()));
    x = prior.x - covariance * sum.gradient();
    benchmark::DoNotOptimize(x.data());
    next = (next + 1) % windows.size();
  }
  if (!x.allFinite() || windows.empty()) {
    state.SkipWithError("nothing was found");
  }
  state.counters["parameters"] = static_cast<double>(model.space().size());
}

/// The whole cycle `motion` of so many seconds, as calibrate_bag runs it: from the drawing to
/// parameters, verdict and report.
void calibrateMotion(benchmark::State& state) {
  const auto seconds = static_cast<double>(state.range(0));
  const MovingRotor moving = movingUnit(seconds);
  const auto recording = std::make_shared<const MotionRecording>(noisyMotion(moving));
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
