#include <gtest/gtest.h>

#include "calibration/sensor_noise.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "support/calibration_trials.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr CycleRequest kJointCycle{Cycle::kJoint};

class JointCalibration : public testing::Test {
 protected:
  std::vector<Sample> samples(std::size_t poses, double tilt, double noise, std::uint64_t seed) {
    scenarios::Generator generator(seed);
    std::vector<Eigen::Vector3d> q = scenarios::randomPoses(poses, tilt, generator);
    return scenarios::orientationSamples(
        truth_, q, noise, scenarios::uniformStddev(kOrientationNoise), generator);
  }

  CycleOutcome run(const std::vector<Sample>& samples) const {
    return runCycle(model_, samples, nominal_, kJointCycle, options_);
  }

  const Actuator truth_ = scenarios::paperTruth();
  const CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  const ParameterSpace& space_ = model_.space();
  const Eigen::VectorXd x_true_ = space_.coordinatesOf(truth_);
  const CalibrationState nominal_ = nominalState(space_, ManufacturingTolerance());
  const EstimationOptions options_{};
};

TEST_F(JointCalibration, RecoversTable3ExactlyFromFiveOrientations) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const CycleOutcome outcome = run(samples(5, 0.6, 0.0, seed));
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    EXPECT_LE(outcome.report.iterations, 4u) << "seed " << seed;
    EXPECT_LT((outcome.state.belief.x - x_true_).head(9).cwiseAbs().maxCoeff(), 1e-12);
    const Actuator found = space_.actuatorAt(outcome.state.belief.x);
    for (std::size_t k = 0; k < kJoints; ++k) {
      EXPECT_LT((found.joints[k].axis - truth_.joints[k].axis).norm(), 1e-12);
      EXPECT_NEAR(found.joints[k].offset, truth_.joints[k].offset, 1e-12);
    }
    EXPECT_EQ(outcome.report.error_history.size(), outcome.report.iterations + 1u);
    EXPECT_GT(outcome.report.error_history.front(), 0.03);
    EXPECT_LT(outcome.report.error_history.back(), 1e-12);
  }
}

TEST_F(JointCalibration, ReachesTheBoundAndItsIntervalsAreTrue) {
  const std::vector<Eigen::Index> free{0, 1, 2, 3, 4, 5, 6, 7, 8};
  for (const std::size_t poses : {std::size_t{5}, std::size_t{10}, std::size_t{30}}) {
    TrialStatistics statistics;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const std::vector<Sample> data = samples(poses, 0.6, kOrientationNoise, 1000 + seed);
      const CycleOutcome outcome = run(data);
      ASSERT_TRUE(outcome.report.success) << outcome.report.message;
      EXPECT_EQ(outcome.report.samples_rejected, 0u);
      statistics.add(outcome.state.belief,
                     x_true_,
                     free,
                     cramerRaoBound(model_, data, kJointCycle, free, x_true_));
    }
    RecordProperty("poses_" + std::to_string(poses) + "_error_over_bound",
                   std::to_string(statistics.errorOverBound()));
    RecordProperty("poses_" + std::to_string(poses) + "_coverage",
                   std::to_string(statistics.coverage()));
    EXPECT_LE(statistics.meanErrorOverBound(), 1.03) << poses;
    EXPECT_LE(statistics.errorOverBound(), 1.03) << poses;
    EXPECT_GE(statistics.coverage(), 0.94) << poses;
    EXPECT_LE(statistics.coverage(), 0.96) << poses;
  }
}

TEST_F(JointCalibration, RemainingErrorLiesBelowTheAddedNoiseFromTenOrientations) {
  const JointGeometry joints = jointGeometry(truth_.joints);
  for (const std::size_t poses : {std::size_t{10}, std::size_t{20}, std::size_t{40}}) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const std::vector<Sample> data = samples(poses, 0.6, kOrientationNoise, 2000 + seed);
      double added = 0.0;
      for (const Sample& sample : data) {
        added += rotationLog(sample.R_stator_rotor *
                             rotorOrientation(joints, sample.joint_position).transpose())
                     .norm() /
                 static_cast<double>(poses);
      }
      EXPECT_LT(run(data).report.error_history.back(), added) << poses << " seed " << seed;
    }
  }
}

TEST_F(JointCalibration, ConvergesFromHalfARadianWhereThatIsWithinTolerances) {
  EstimationOptions coarse;
  coarse.tolerance.joint_offset = 0.3;
  coarse.tolerance.joint_axis = 0.3;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    scenarios::Generator generator(seed);
    const Actuator far = scenarios::perturbed(scenarios::paperNominal(), 0.5, 0.0, generator);
    std::vector<Eigen::Vector3d> q = scenarios::randomPoses(10, 0.6, generator);
    const std::vector<Sample> data = scenarios::orientationSamples(far, q, 0.0, 1e-3, generator);
    const CycleOutcome outcome = runCycle(model_, data, nominal_, kJointCycle, coarse);
    ASSERT_TRUE(outcome.report.success) << outcome.report.message;
    EXPECT_LT((outcome.state.belief.x - space_.coordinatesOf(far)).head(9).norm(), 1e-10);
    const CycleOutcome refused = run(data);
    EXPECT_FALSE(refused.report.success);
    EXPECT_TRUE(refused.report.contradicted);
    EXPECT_NE(refused.report.message.find("tolerances"), std::string::npos)
        << refused.report.message;
    EXPECT_EQ(refused.state.belief.x, nominal_.belief.x);
  }
}

TEST_F(JointCalibration, ReportsEveryParameterWithNominalInitialAndStddev) {
  const CycleOutcome outcome = run(samples(10, 0.6, kOrientationNoise, 4));
  ASSERT_EQ(outcome.report.estimates.size(), 9u);
  for (const ParameterEstimate& estimate : outcome.report.estimates) {
    EXPECT_TRUE(estimate.observable) << estimate.name;
    EXPECT_EQ(estimate.nominal, 0.0);
    EXPECT_EQ(estimate.initial, 0.0);
    EXPECT_GT(estimate.stddev, 1e-5);
    EXPECT_LT(estimate.stddev, 5e-3);
  }
  EXPECT_EQ(outcome.report.estimates[3].name, "joint_2/offset");
  EXPECT_NEAR(outcome.report.estimates[3].value, 0.025, 5e-3);
  EXPECT_EQ(outcome.report.residuals.size(), 10u);
  EXPECT_GT(outcome.report.orientation_uncertainty, 1e-5);
  EXPECT_LT(outcome.report.orientation_uncertainty, 2e-3);
}

TEST_F(JointCalibration, JointSensorNoiseWidensTheIntervals) {
  std::vector<Sample> data = samples(10, 0.6, kOrientationNoise, 5);
  const double without = run(data).report.estimates[0].stddev;
  for (Sample& sample : data) {
    sample.joint_stddev.setConstant(2e-3);
  }
  EXPECT_GT(run(data).report.estimates[0].stddev, 2.0 * without);
}

TEST_F(JointCalibration, LeavesTheAxisOfAJointThatDoesNotMove) {
  std::vector<Sample> data = samples(20, 0.6, kOrientationNoise, 6);
  const JointGeometry joints = jointGeometry(truth_.joints);
  for (Sample& sample : data) {
    sample.joint_position[2] = 0.0;
    sample.R_stator_rotor = rotorOrientation(joints, sample.joint_position);
  }
  const CycleOutcome outcome = run(data);
  ASSERT_TRUE(outcome.report.success) << outcome.report.message;
  EXPECT_NE(outcome.report.message.find("axis of joint_3 is not observable"), std::string::npos)
      << outcome.report.message;
  EXPECT_EQ(outcome.state.belief.x[7], 0.0);
  EXPECT_EQ(outcome.state.belief.x[8], 0.0);
  for (const ParameterEstimate& estimate : outcome.report.estimates) {
    const bool of_axis_3 = estimate.name.rfind("joint_3/axis", 0) == 0;
    EXPECT_EQ(estimate.observable, !of_axis_3) << estimate.name;
  }
  EXPECT_FALSE(outcome.state.identified[7]);
  EXPECT_TRUE(outcome.state.identified[6]);
}

TEST_F(JointCalibration, RefusesTooFewSamplesAndChangesNothing) {
  const CycleOutcome outcome = run(samples(2, 0.6, kOrientationNoise, 7));
  EXPECT_FALSE(outcome.report.success);
  EXPECT_NE(outcome.report.message.find("at least 3 poses"), std::string::npos);
  EXPECT_TRUE(outcome.report.estimates.empty());
  EXPECT_EQ(outcome.state.belief.x, nominal_.belief.x);
}

TEST_F(JointCalibration, RefusesARotorThatStandsStill) {
  std::vector<Sample> data = samples(1, 0.6, 0.0, 8);
  data.resize(10, data.front());
  const CycleOutcome outcome = run(data);
  EXPECT_FALSE(outcome.report.success);
  EXPECT_NE(outcome.report.message.find("stands still"), std::string::npos);
}

TEST_F(JointCalibration, RefusesSamplesThatDoNotBelongToTheirAngles) {
  std::vector<Sample> data = samples(20, 0.6, 0.0, 9);
  std::rotate(data.begin(), data.begin() + 1, data.end());
  for (std::size_t n = 0; n + 1 < data.size(); ++n) {
    std::swap(data[n].R_stator_rotor, data[n + 1].R_stator_rotor);
  }
  const CycleOutcome outcome = run(data);
  EXPECT_FALSE(outcome.report.success) << outcome.report.message;
  EXPECT_EQ(outcome.state.belief.x, nominal_.belief.x);
}

TEST_F(JointCalibration, NeverUsesHeldOutSamples) {
  std::vector<Sample> data = samples(12, 0.6, kOrientationNoise, 10);
  const std::vector<Sample> ten(data.begin(), data.begin() + 10);
  for (std::size_t n = 10; n < data.size(); ++n) {
    data[n].validation = true;
    data[n].R_stator_rotor.setIdentity();
  }
  EXPECT_EQ(run(data).state.belief.x, run(ten).state.belief.x);
}

TEST_F(JointCalibration, ThrowsOnASampleThatIsNotFinite) {
  std::vector<Sample> data = samples(10, 0.6, kOrientationNoise, 11);
  data[3].joint_position[1] = std::nan("");
  EXPECT_THROW(run(data), DataError);
}

TEST_F(JointCalibration, UnderstatedNoiseWidensTheIntervals) {
  std::vector<Sample> data = samples(30, 0.6, kOrientationNoise, 12);
  const CycleOutcome honest = run(data);
  for (Sample& sample : data) {
    sample.orientation_stddev /= 2.5;
  }
  const CycleOutcome outcome = run(data);
  ASSERT_TRUE(outcome.report.success) << outcome.report.message;
  EXPECT_NEAR(outcome.report.reduced_chi_square, 6.25 * honest.report.reduced_chi_square, 0.1);
  EXPECT_GT(outcome.report.estimates[0].stddev, 0.8 * honest.report.estimates[0].stddev);
}

}  // namespace
}  // namespace sac
