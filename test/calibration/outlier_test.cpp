#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

std::set<std::uint32_t> rejectedIds(const CycleReport& report) {
  std::set<std::uint32_t> ids;
  for (const SampleResidual& residual : report.residuals) {
    if (residual.rejected) {
      ids.insert(residual.id);
      EXPECT_FALSE(residual.reason.empty());
      EXPECT_GT(residual.standardized, 3.0);
    }
  }
  return ids;
}

class Outliers : public testing::Test {
 protected:
  const Actuator truth_ = scenarios::paperTruth();
  const CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  const ParameterSpace& space_ = model_.space();
  const EstimationOptions options_{};
};

TEST_F(Outliers, OfOrientationAreFoundAndTheRestFitsAsIfTheyWereAbsent) {
  const CalibrationState nominal = nominalState(space_, ManufacturingTolerance());
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    scenarios::Generator generator(seed);
    std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(15, 0.6, generator);
    std::vector<Sample> data = scenarios::orientationSamples(
        truth_, poses, 1e-3, scenarios::uniformStddev(1e-3), generator);
    std::vector<Sample> clean;
    for (std::size_t n = 0; n < data.size(); ++n) {
      if (n == 2 || n == 7 || n == 11) {
        const Eigen::Vector3d direction = scenarios::uniformNoise(1.0, generator).normalized();
        data[n].R_stator_rotor = rotationExp(0.02 * direction) * data[n].R_stator_rotor;
      } else {
        clean.push_back(data[n]);
      }
    }
    const CycleOutcome outcome = runCycle(model_, data, nominal, {Cycle::kJoint}, options_);
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    EXPECT_EQ(rejectedIds(outcome.report), (std::set<std::uint32_t>{3, 8, 12})) << "seed " << seed;
    EXPECT_EQ(outcome.report.samples_rejected, 3u);
    EXPECT_EQ(outcome.report.samples_used, 12u);
    const CycleOutcome expected = runCycle(model_, clean, nominal, {Cycle::kJoint}, options_);
    EXPECT_LT((outcome.state.belief.x - expected.state.belief.x).norm(), 1e-9);
  }
}

TEST_F(Outliers, AreToldAsADoubtWhereTheyAreMoreThanAQuarter) {
  const CalibrationState nominal = nominalState(space_, ManufacturingTolerance());
  const auto doubts = [&](std::size_t outliers) {
    scenarios::Generator generator(5);
    const auto poses = scenarios::randomPoses(21, 0.6, generator);
    std::vector<Sample> data = scenarios::orientationSamples(
        truth_, poses, 1e-3, scenarios::uniformStddev(1e-3), generator);
    for (std::size_t n = 0; n < outliers; ++n) {
      const Eigen::Vector3d direction = scenarios::uniformNoise(1.0, generator).normalized();
      data[3 * n].R_stator_rotor = rotationExp(0.02 * direction) * data[3 * n].R_stator_rotor;
    }
    const CycleReport report = runCycle(model_, data, nominal, {Cycle::kJoint}, options_).report;
    EXPECT_EQ(report.samples_rejected, outliers);
    return report.doubts;
  };
  EXPECT_TRUE(doubts(5).empty());
  ASSERT_EQ(doubts(6).size(), 1U);
  EXPECT_EQ(doubts(6).front().rfind("6 of 21 orientations were left out as outliers", 0), 0U);
}

TEST_F(Outliers, SensorsThatStoodStillAreADoubt) {
  const CalibrationState nominal = nominalState(space_, ManufacturingTolerance());
  const auto doubts = [&](std::size_t still, bool is_moved) {
    scenarios::Generator generator(5);
    const auto poses = scenarios::randomPoses(21, 0.6, generator);
    std::vector<Sample> data = scenarios::orientationSamples(
        truth_, poses, 1e-3, scenarios::uniformStddev(1e-3), generator);
    for (std::size_t n = 0; n < still; ++n) {
      data[20 - n].R_stator_rotor = data[0].R_stator_rotor;
      if (!is_moved) {
        data[20 - n].joint_position = data[0].joint_position;
      }
    }
    return runCycle(model_, data, nominal, {Cycle::kJoint}, options_).report.doubts;
  };
  EXPECT_TRUE(doubts(5, true).empty());
  EXPECT_TRUE(doubts(8, false).empty());  // rows that are doubled count once, and are right
  ASSERT_EQ(doubts(6, true).size(), 1U);
  EXPECT_EQ(doubts(6, true).front().rfind("6 of 21 orientations are those of another pose", 0), 0U);
}

TEST_F(Outliers, OfTorqueAreFoundAndTheRestFitsAsIfTheyWereAbsent) {
  const CalibrationState state = scenarios::exactJoints(space_, truth_, ManufacturingTolerance());
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    scenarios::Generator generator(100 + seed);
    const auto poses = scenarios::posesThatSeeEveryPole(truth_, 0, 40, 0.3, generator);
    std::vector<Sample> data = scenarios::torqueSamples(
        truth_, poses, 0, 2.0, 5e-4, scenarios::uniformStddev(5e-4), generator);
    std::vector<Sample> clean;
    for (std::size_t n = 0; n < data.size(); ++n) {
      if (n == 5 || n == 20 || n == 33) {
        data[n].torque += 0.1 * scenarios::uniformNoise(1.0, generator).normalized();
      } else {
        clean.push_back(data[n]);
      }
    }
    const CycleOutcome outcome = runCycle(model_, data, state, {Cycle::kPoles, 0}, options_);
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    EXPECT_EQ(rejectedIds(outcome.report), (std::set<std::uint32_t>{6, 21, 34})) << "seed " << seed;
    const CycleOutcome expected = runCycle(model_, clean, state, {Cycle::kPoles, 0}, options_);
    EXPECT_LT((outcome.state.belief.x - expected.state.belief.x).norm(), 1e-9);
  }
}

TEST_F(Outliers, FaultlessGaussianSamplesAreHardlyEverRejected) {
  const CalibrationState nominal = nominalState(space_, ManufacturingTolerance());
  int rejected = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    scenarios::Generator generator(200 + seed);
    std::normal_distribution<double> normal(0.0, 1e-3);
    std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(30, 0.6, generator);
    std::vector<Sample> data = scenarios::orientationSamples(truth_, poses, 0.0, 1e-3, generator);
    for (Sample& sample : data) {
      const double x = normal(generator);
      const double y = normal(generator);
      sample.R_stator_rotor = rotationExp({x, y, normal(generator)}) * sample.R_stator_rotor;
    }
    const CycleOutcome outcome = runCycle(model_, data, nominal, {Cycle::kJoint}, options_);
    ASSERT_TRUE(outcome.report.success);
    rejected += static_cast<int>(outcome.report.samples_rejected);
  }
  EXPECT_LE(rejected, 3);  // stated: one set in a thousand
}

/// A coil cycle whose only sample was faulty leaves the coil far away. From there the good samples
/// look like outliers; they must call the coil back all the same.
TEST_F(Outliers, AWrongStartDoesNotRejectTheSamplesThatCorrectIt) {
  constexpr std::size_t kCoil = 17;
  const Eigen::Index at = space_.coil(kCoil);
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    scenarios::Generator generator(400 + seed);
    const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
    std::vector<Sample> data =
        scenarios::paperSession(truth, scenarios::Tracker::kEveryPose, generator);
    CalibrationState state = nominalState(space_, ManufacturingTolerance());
    for (const CycleRequest& request : {CycleRequest{Cycle::kJoint}, {Cycle::kPoles, 0}}) {
      state = runCycle(model_, data, state, request, options_).state;
    }
    const double direction = 0.7 * static_cast<double>(seed);
    state.belief.x.segment<2>(at) = 0.3 * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    state.identified[static_cast<std::size_t>(at)] = true;
    const auto faulty = std::find_if(data.begin(), data.end(), [](const Sample& sample) {
      return sample.has_torque && sample.current[kCoil] != 0.0;
    });
    faulty->torque += Eigen::Vector3d(0.15, -0.1, 0.1);
    const CycleOutcome outcome = runCycle(model_, data, state, {Cycle::kRefine}, options_);
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    EXPECT_EQ(rejectedIds(outcome.report), (std::set<std::uint32_t>{faulty->id})) << seed;
    EXPECT_TRUE(outcome.state.identified[static_cast<std::size_t>(at)]);
    const Eigen::VectorXd error = outcome.state.belief.x - space_.coordinatesOf(truth);
    EXPECT_LT(error.segment<2>(at).norm(), 5e-3) << outcome.report.message;
  }
}

TEST_F(Outliers, TooManyMeanContradiction) {
  scenarios::Generator generator(300);
  std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(20, 0.6, generator);
  std::vector<Sample> data = scenarios::orientationSamples(truth_, poses, 1e-3, 6e-4, generator);
  for (std::size_t n = 0; n < 9; ++n) {
    data[n].R_stator_rotor =
        rotationExp(scenarios::uniformNoise(0.5, generator)) * data[n].R_stator_rotor;
  }
  const CalibrationState nominal = nominalState(space_, ManufacturingTolerance());
  const CycleOutcome outcome = runCycle(model_, data, nominal, {Cycle::kJoint}, options_);
  EXPECT_FALSE(outcome.report.success);
  EXPECT_EQ(outcome.state.belief.x, nominal.belief.x);
  EXPECT_NE(outcome.report.message.find("samples"), std::string::npos) << outcome.report.message;
}

}  // namespace
}  // namespace sac
