#include <gtest/gtest.h>

#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/calibration_trials.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// The paper's whole sequence with all noises at once: level 1, poles with coil 1, then coils 2…24.
class SequentialCalibration : public testing::Test {
 protected:
  std::vector<Sample> session(const Actuator& truth, std::uint64_t seed) const {
    scenarios::Generator generator(seed);
    return scenarios::paperSession(truth, scenarios::Tracker::kFirstTenPoses, generator);
  }

  CalibrationState calibrate(const std::vector<Sample>& samples) const {
    CalibrationState state = nominalState(space_, ManufacturingTolerance());
    std::vector<CycleRequest> requests{{Cycle::kJoint}, {Cycle::kPoles, 0}};
    for (std::size_t coil = 1; coil < space_.coils(); ++coil) {
      requests.push_back({Cycle::kCoil, coil});
    }
    for (const CycleRequest& request : requests) {
      const CycleOutcome outcome = runCycle(model_, samples, state, request, options_);
      EXPECT_TRUE(outcome.report.success) << outcome.report.message;
      EXPECT_EQ(outcome.report.samples_rejected, 0u) << outcome.report.message;
      state = outcome.state;
    }
    return state;
  }

  const CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  const ParameterSpace& space_ = model_.space();
  const EstimationOptions options_{};
};

TEST_F(SequentialCalibration, IntervalsHoldAlthoughEachCycleTrustsTheOneBefore) {
  TrialStatistics statistics;
  std::vector<Eigen::Index> all;
  for (Eigen::Index p = 0; p < space_.size(); ++p) {
    all.push_back(p);
  }
  const Eigen::MatrixXd no_bound = Eigen::MatrixXd::Identity(space_.size(), space_.size());
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    scenarios::Generator generator(900 + seed);
    const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
    const CalibrationState state = calibrate(session(truth, seed));
    statistics.add(state.belief, space_.coordinatesOf(truth), all, no_bound);
  }
  RecordProperty("coverage", std::to_string(statistics.coverage()));
  // Errors within one session share the error of level 1, so the share scatters more than its count
  // of parameters suggests.
  EXPECT_GE(statistics.coverage(), 0.93);
  EXPECT_LE(statistics.coverage(), 0.97);
}

TEST_F(SequentialCalibration, RefinementOfEverythingIsBetterThanTheSequence) {
  double sequential = 0.0;
  double refined = 0.0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    scenarios::Generator generator(950 + seed);
    const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
    const std::vector<Sample> samples = session(truth, 500 + seed);
    const CalibrationState state = calibrate(samples);
    const CycleOutcome outcome = runCycle(model_, samples, state, {Cycle::kRefine}, options_);
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    const Eigen::VectorXd x_true = space_.coordinatesOf(truth);
    sequential += (state.belief.x - x_true).squaredNorm();
    refined += (outcome.state.belief.x - x_true).squaredNorm();
  }
  EXPECT_LT(refined, sequential / 4.0);
}

}  // namespace
}  // namespace sac
