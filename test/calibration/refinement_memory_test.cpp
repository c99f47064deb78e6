#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/resident_memory.hpp"
#include "support/scenarios.hpp"

#include <malloc.h>

namespace sac {
namespace {

TEST(RefinementMemory, StaysBelow150BytesASampleBesideTheSamples) {
  constexpr std::size_t kPosesOfCoil = 4000;
  scenarios::Generator generator(1);
  const Actuator truth = scenarios::paperNominal();
  const CalibrationModel model{ParameterSpace(truth)};
  const auto noise = scenarios::uniformStddev(5e-4);
  std::vector<Sample> samples = scenarios::orientationSamples(
      truth, scenarios::randomPoses(kPosesOfCoil, 0.3, generator), 0.0, noise, generator);
  for (std::size_t coil = 0; coil < truth.coils.size(); ++coil) {
    const auto poses = scenarios::randomPoses(kPosesOfCoil, 0.3, generator);
    const auto more = scenarios::torqueSamples(truth, poses, coil, 2.0, 0.0, noise, generator);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  samples.shrink_to_fit();
  const CalibrationState start = nominalState(model.space(), ManufacturingTolerance());
  const auto refine = [&] {
    const CycleOutcome outcome = runCycle(model, samples, start, {Cycle::kRefine}, {});
    EXPECT_TRUE(outcome.report.success) << outcome.report.message;
  };
  // Large blocks go back as soon as they are free: what is resident is what is in use.
  constexpr int kLargeBlock = 1 << 16;
  ::mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  refine();  // the first one brings the program into memory, too
  const double memory = peakBeside(refine);
  constexpr double kPages = 16.0 * 4096.0;  // [bytes] in which the program itself differs
  EXPECT_LE(memory - kPages, 150.0 * static_cast<double>(samples.size()));
}

}  // namespace
}  // namespace sac
