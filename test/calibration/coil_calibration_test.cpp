#include <gtest/gtest.h>

#include "calibration/sensor_noise.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/calibration_trials.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr CycleRequest kCoil2{Cycle::kCoil, 1};

class CoilCalibration : public testing::Test {
 protected:
  CoilCalibration() {
    // Poles and coil 1 known exactly, too: what the paper assumes before situation 2.
    const Eigen::Index last = space_.coil(1);
    poles_known_.belief.x.head(last) = x_true_.head(last);
    poles_known_.belief.covariance.topLeftCorner(last, last).setZero();
    std::fill(poles_known_.identified.begin(), poles_known_.identified.begin() + last, true);
  }

  std::vector<Sample> samples(double noise, std::uint64_t seed) const {
    scenarios::Generator generator(seed);
    const auto poses = scenarios::posesThatSeeEveryPole(truth_, 1, 4, 0.3, generator);
    return scenarios::torqueSamples(
        truth_, poses, 1, 2.0, noise, scenarios::uniformStddev(kTorqueNoise), generator);
  }

  CycleOutcome run(const std::vector<Sample>& samples) const {
    return runCycle(model_, samples, poles_known_, kCoil2, options_);
  }

  const Actuator truth_ = scenarios::paperTruth();
  const CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  const ParameterSpace& space_ = model_.space();
  const Eigen::VectorXd x_true_ = space_.coordinatesOf(truth_);
  CalibrationState poles_known_ = scenarios::exactJoints(space_, truth_, ManufacturingTolerance());
  const EstimationOptions options_{};
};

TEST_F(CoilCalibration, RecoversCoil2ExactlyFromFourOrientations) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const CycleOutcome outcome = run(samples(0.0, seed));
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    EXPECT_LE(outcome.report.iterations, 5u) << "seed " << seed;
    EXPECT_LT((outcome.state.belief.x - x_true_).segment<2>(space_.coil(1)).norm(), 1e-10);
    const Actuator found = space_.actuatorAt(outcome.state.belief.x);
    EXPECT_NEAR(found.coils[1].polar, 0.2768, 1e-4);
    EXPECT_NEAR(found.coils[1].azimuth, 0.5436, 1e-4);
  }
}

TEST_F(CoilCalibration, ReachesTheBoundAndItsIntervalsAreTrue) {
  TrialStatistics statistics;
  const std::vector<Eigen::Index> free{space_.coil(1), space_.coil(1) + 1};
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const std::vector<Sample> data = samples(kTorqueNoise, 6000 + seed);
    const CycleOutcome outcome = run(data);
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    statistics.add(
        outcome.state.belief, x_true_, free, cramerRaoBound(model_, data, kCoil2, free, x_true_));
  }
  RecordProperty("error_over_bound", std::to_string(statistics.errorOverBound()));
  RecordProperty("coverage", std::to_string(statistics.coverage()));
  EXPECT_LE(statistics.errorOverBound(), 1.05);
  EXPECT_GE(statistics.coverage(), 0.94);
  EXPECT_LE(statistics.coverage(), 0.96);
}

TEST_F(CoilCalibration, IsRefusedBeforeThePoles) {
  const CycleOutcome outcome = runCycle(
      model_, samples(0.0, 1), nominalState(space_, ManufacturingTolerance()), kCoil2, options_);
  EXPECT_FALSE(outcome.report.success);
  EXPECT_NE(outcome.report.message.find("run the poles cycle before coil 2"), std::string::npos)
      << outcome.report.message;
}

TEST_F(CoilCalibration, NamesACoilThatSeesNoPole) {
  std::vector<Sample> data = samples(0.0, 2);
  for (Sample& sample : data) {
    // Upright, with coil 2 halfway between two poles of a rotor that leans away from it.
    sample.joint_position << 0.0, 0.6, -0.2;
    sample.torque.setZero();
  }
  const CycleOutcome outcome = run(data);
  EXPECT_FALSE(outcome.report.success);
  EXPECT_NE(outcome.report.message.find("Coil 2 "), std::string::npos) << outcome.report.message;
}

TEST_F(CoilCalibration, TouchesNoOtherParameter) {
  const CycleOutcome outcome = run(samples(kTorqueNoise, 3));
  Eigen::VectorXd x = outcome.state.belief.x;
  x.segment<2>(space_.coil(1)).setZero();
  EXPECT_EQ(x, poles_known_.belief.x);
}

}  // namespace
}  // namespace sac
