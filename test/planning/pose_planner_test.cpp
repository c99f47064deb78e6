#include "spherical_actuator_calibration/planning/pose_planner.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "planning/planning_fixture.hpp"
#include "pose_candidates.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/measurement/torque_pose_sampler.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"
#include "spherical_actuator_calibration/study/cramer_rao_bound.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

class PosePlanner : public PlanningFixture {
 protected:
  PosePlanner() {
    options_.candidates = 150;  // for the speed of the tests
  }
};

std::vector<std::string> namesOf(const std::vector<ParameterEstimate>& estimates) {
  std::vector<std::string> names;
  names.reserve(estimates.size());
  for (const ParameterEstimate& estimate : estimates) {
    names.push_back(estimate.name);
  }
  return names;
}

bool isAllObservable(const PosePlan& plan) {
  return std::all_of(plan.expected.begin(), plan.expected.end(), [](const auto& estimate) {
    return estimate.observable;
  });
}

TEST_F(PosePlanner, BeatsThePapersProtocolWithTenPoses) {
  options_.candidates = PosePlanOptions{}.candidates;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    scenarios::Generator generator(seed);
    options_.seed = seed;
    const PosePlan plan = planPoses(problem_, options_);
    ASSERT_TRUE(plan.success) << plan.message;
    EXPECT_TRUE(isAllObservable(plan));
    EXPECT_LE(plan.poses.size(), 10U);
    EXPECT_LE(plan.torque_samples, 60U);
    EXPECT_EQ(plan.orientation_samples, plan.poses.size());
    const std::vector<Sample> aimed =
        scenarios::paperSession(nominal_, scenarios::Tracker::kFirstTenPoses, generator);
    EXPECT_LT(plan.worst_stddev, boundOf(aimed).maxCoeff());
    EXPECT_LT(plan.worst_stddev, boundOf(scenarios::randomSession(nominal_, generator)).maxCoeff());
  }
}

TEST_F(PosePlanner, ExpectsTheCramerRaoBoundOfTheSamplesThatItAsksFor) {
  const PosePlan plan = planPoses(problem_, options_);
  const Eigen::VectorXd bound = boundOf(samplesOf(plan));
  ASSERT_EQ(plan.expected.size(), static_cast<std::size_t>(bound.size()));
  for (std::size_t n = 0; n < plan.expected.size(); ++n) {
    EXPECT_NEAR(plan.expected[n].stddev / bound[static_cast<Eigen::Index>(n)], 1.0, 1e-6)
        << plan.expected[n].name;
  }
  EXPECT_NEAR(plan.worst_stddev / bound.maxCoeff(), 1.0, 1e-6);
}

TEST_F(PosePlanner, StaysInsideTheLimitsAndAwayFromUncertainAngles) {
  options_.tilt_limit = 0.2;
  options_.spin_minimum = -2.0;
  options_.spin_maximum = 2.5;
  options_.coils_per_pose = 4;
  options_.minimum_spacing = 0.4;
  options_.max_poses = 10;
  const PosePlan plan = planPoses(problem_, options_);
  ASSERT_EQ(plan.poses.size(), 10U) << plan.message;
  const JointGeometry joints = jointGeometry(nominal_.joints);
  const TorquePoseSampler sampler(nominal_, 0.2);
  for (std::size_t n = 0; n < plan.poses.size(); ++n) {
    const PlannedPose& pose = plan.poses[n];
    EXPECT_LE(pose.joint_position.head<2>().cwiseAbs().maxCoeff(), 0.2);
    EXPECT_GE(pose.joint_position[2], -2.0);
    EXPECT_LE(pose.joint_position[2], 2.5);
    EXPECT_LE(pose.coils.size(), 4U);
    for (const std::size_t coil : pose.coils) {
      EXPECT_EQ(sampler.grade(pose.joint_position, coil, std::nullopt), PoseGrade::kClear);
    }
    const Eigen::Matrix3d R = rotorOrientation(joints, pose.joint_position);
    for (std::size_t m = 0; m < n; ++m) {
      const Eigen::AngleAxisd move(R.transpose() *
                                   rotorOrientation(joints, plan.poses[m].joint_position));
      EXPECT_GE(move.angle(), 0.4);
    }
  }
}

TEST_F(PosePlanner, StopsAtTheWantedStandardDeviation) {
  options_.max_poses = 30;
  options_.wanted_stddev = 3e-4;
  const PosePlan plan = planPoses(problem_, options_);
  EXPECT_TRUE(plan.reached_wanted);
  EXPECT_LE(plan.worst_stddev, 3e-4);
  EXPECT_LE(plan.poses.size(), 10U);
  EXPECT_EQ(plan.poses_needed, plan.poses.size());
}

TEST_F(PosePlanner, TellsHowManyPosesTheWantedStandardDeviationNeeds) {
  options_.wanted_stddev = 1e-4;
  const PosePlan plan = planPoses(problem_, options_);
  EXPECT_TRUE(plan.success);
  EXPECT_FALSE(plan.reached_wanted);
  ASSERT_TRUE(plan.poses_needed.has_value());
  EXPECT_GT(*plan.poses_needed, 30U);
  EXPECT_LT(*plan.poses_needed, 100U);
  EXPECT_NE(plan.message.find("poses are needed for 0.1 mrad"), std::string::npos) << plan.message;
}

TEST_F(PosePlanner, CountsTheSamplesHeld) {
  const PosePlan first = planPoses(problem_, options_);
  options_.max_poses = 5;
  std::vector<Sample> together = samplesOf(planPoses(problem_, options_));
  held_ = samplesOf(first);
  const PosePlan second = planPoses(problem_, options_);
  EXPECT_LT(second.worst_stddev, first.worst_stddev);
  // A plan that does not know of them adds less.
  together.insert(together.end(), held_.begin(), held_.end());
  EXPECT_LT(second.worst_stddev, boundOf(together).maxCoeff());
  options_.wanted_stddev = 1.01 * first.worst_stddev;
  const PosePlan third = planPoses(problem_, options_);
  EXPECT_TRUE(third.success);
  EXPECT_TRUE(third.poses.empty());
  EXPECT_NE(third.message.find("No pose is needed"), std::string::npos) << third.message;
}

TEST_F(PosePlanner, MakesUpForAPoleThatNoSampleSees) {
  PosePlan first = planPoses(problem_, options_);
  held_ = samplesOf(first);
  // Without the torques that coils exert on pole 3 it is not identified.
  const Actuator belief = model_.space().actuatorAt(problem_.state.belief.x);
  const Eigen::MatrixXd held_covariance =
      cramerRaoBound(model_, held_, {Cycle::kRefine}, allCoordinates(), problem_.state.belief.x);
  ASSERT_TRUE(held_covariance.allFinite());
  held_.erase(std::remove_if(held_.begin(),
                             held_.end(),
                             [&](const Sample& sample) {
                               Actuator other = belief;
                               other.poles[2].gain = 2.0;
                               Sample changed = sample;
                               const CalibrationModel of_other{ParameterSpace(other)};
                               predictMeasurements({of_other, problem_.state.belief.x}, changed);
                               return !changed.torque.isApprox(sample.torque);
                             }),
              held_.end());
  options_.max_poses = 2;
  const PosePlan plan = planPoses(problem_, options_);
  const auto pole = std::find_if(plan.expected.begin(), plan.expected.end(), [](const auto& e) {
    return e.name == "pole_3/polar";
  });
  ASSERT_NE(pole, plan.expected.end());
  EXPECT_TRUE(pole->observable);
  EXPECT_LT(pole->stddev, 1e-3);
}

TEST_F(PosePlanner, PlansForOneCycle) {
  problem_.request = {Cycle::kJoint};
  PosePlan plan = planPoses(problem_, options_);
  EXPECT_TRUE(plan.success);
  EXPECT_EQ(plan.expected.size(), 9U);
  EXPECT_EQ(plan.torque_samples, 0U);

  // The orientation is known: what remains is the pole angles and those of the coil.
  const Eigen::Index joints = model_.space().pole(0);
  problem_.state.belief.covariance.topLeftCorner(joints, joints) *= 1e-6;
  problem_.request = {Cycle::kPoles, 2};
  options_.max_poses = 12;
  plan = planPoses(problem_, options_);
  EXPECT_TRUE(isAllObservable(plan)) << plan.message;
  EXPECT_EQ(plan.expected.size(), 18U);
  EXPECT_EQ(plan.orientation_samples, 0U);
  for (const PlannedPose& pose : plan.poses) {
    EXPECT_EQ(pose.coils, std::vector<std::size_t>{2});
  }

  std::fill(problem_.state.identified.begin(), problem_.state.identified.end(), true);
  problem_.state.belief.covariance *= 1e-6;
  problem_.request = {Cycle::kCoil, 23};
  plan = planPoses(problem_, options_);
  EXPECT_TRUE(isAllObservable(plan)) << plan.message;
  EXPECT_EQ(namesOf(plan.expected), (std::vector<std::string>{"coil_24/polar", "coil_24/azimuth"}));
}

TEST_F(PosePlanner, OptimisesTheVolumeOfTheUncertaintyOnRequest) {
  const auto log_volume = [&](const PosePlan& plan) {
    const Eigen::MatrixXd covariance = cramerRaoBound(
        model_, samplesOf(plan), {Cycle::kRefine}, allCoordinates(), problem_.state.belief.x);
    return covariance.ldlt().vectorD().array().log().sum();
  };
  const PosePlan smallest_worst = planPoses(problem_, options_);
  options_.criterion = PlanCriterion::kInformation;
  const PosePlan smallest_volume = planPoses(problem_, options_);
  EXPECT_LT(log_volume(smallest_volume), log_volume(smallest_worst));
  EXPECT_LT(smallest_worst.worst_stddev, smallest_volume.worst_stddev);
}

TEST_F(PosePlanner, GivesTheSamePlanForTheSameSeed) {
  options_.max_poses = 6;
  const PosePlan first = planPoses(problem_, options_);
  const PosePlan again = planPoses(problem_, options_);
  options_.seed = 2;
  const PosePlan other = planPoses(problem_, options_);
  ASSERT_EQ(first.poses.size(), again.poses.size());
  for (std::size_t n = 0; n < first.poses.size(); ++n) {
    EXPECT_EQ(first.poses[n].joint_position, again.poses[n].joint_position);
    EXPECT_EQ(first.poses[n].coils, again.poses[n].coils);
  }
  EXPECT_NE(first.poses.front().joint_position, other.poses.front().joint_position);
}

TEST_F(PosePlanner, SaysWhichParametersStayOpen) {
  options_.max_poses = 3;
  options_.coils_per_pose = 1;
  const PosePlan plan = planPoses(problem_, options_);
  EXPECT_FALSE(isAllObservable(plan));
  EXPECT_FALSE(plan.poses_needed.has_value());
  EXPECT_EQ(plan.message,
            "The planned samples do not determine everything: further poses are needed.");
}

TEST_F(PosePlanner, NamesParametersThatStayOpen) {
  // One coil is excited at each of these poses.
  options_.max_poses = 12;
  options_.coils_per_pose = 1;
  const PosePlan plan = planPoses(problem_, options_);
  ASSERT_FALSE(isAllObservable(plan));
  EXPECT_NE(plan.message.find(" of 73 parameters stay open (pole_"), std::string::npos)
      << plan.message;
  EXPECT_NE(plan.message.find("further poses are needed"), std::string::npos) << plan.message;
}

TEST_F(PosePlanner, PlansJointsOfAnActuatorWithoutTorqueModel) {
  nominal_.poles.clear();
  nominal_.coils.clear();
  nominal_.torque_curve.reset();
  const CalibrationModel joints_only{ParameterSpace(nominal_)};
  problem_.model = &joints_only;
  problem_.state = nominalState(joints_only.space(), {});
  const PosePlan plan = planPoses(problem_, options_);
  EXPECT_TRUE(plan.success);
  EXPECT_EQ(plan.expected.size(), 9U);
  EXPECT_TRUE(isAllObservable(plan));
  problem_.request = {Cycle::kPoles, 0};
  EXPECT_THROW(planPoses(problem_, options_), ConfigError);
}

TEST(PlanOptions, KeepPosesApartByTwiceTheToleranceOfMeasuring) {
  EXPECT_DOUBLE_EQ(kPoseTolerance, 0.5 * PosePlanOptions{}.minimum_spacing);
}

TEST_F(PosePlanner, RefusesOptionsOutOfRange) {
  const auto refuses = [&](auto change) {
    PosePlanOptions options = options_;
    change(options);
    EXPECT_THROW(planPoses(problem_, options), ConfigError);
  };
  refuses([](PosePlanOptions& options) { options.max_poses = 0; });
  refuses([](PosePlanOptions& options) { options.coils_per_pose = 0; });
  refuses([](PosePlanOptions& options) { options.candidates = 0; });
  refuses([](PosePlanOptions& options) { options.wanted_stddev = std::nan(""); });
  refuses([](PosePlanOptions& options) { options.wanted_stddev = -1.0; });
  refuses([](PosePlanOptions& options) { options.tilt_limit = 0.61; });
  refuses([](PosePlanOptions& options) { options.spin_minimum = 4.0; });
  refuses([](PosePlanOptions& options) { options.current = 0.01; });
  refuses([](PosePlanOptions& options) { options.orientation_stddev = 0.0; });
  problem_.request = {Cycle::kCoil, 24};
  EXPECT_THROW(planPoses(problem_, options_), ConfigError);
}

constexpr double kQuieter = 3.0;

class MeasuredNoiseTest : public PlanningFixture {
 protected:
  static Sample tracked(double stddev) {
    Sample sample;
    sample.has_orientation = true;
    sample.orientation_stddev = stddev;
    return sample;
  }

  static Sample torqueOf(double stddev) {
    Sample sample;
    sample.has_torque = true;
    sample.torque_stddev = stddev;
    return sample;
  }
};

TEST_F(MeasuredNoiseTest, IsThatOfMostSamples) {
  held_ = {tracked(1e-4), tracked(3e-4), tracked(2e-4), torqueOf(5e-5), torqueOf(1.0)};
  held_.push_back(torqueOf(4e-5));
  for (Sample& sample : held_) {
    sample.joint_stddev = {1e-5, 0.0, 3e-5};
  }
  const PosePlanOptions measured = withMeasuredNoise(options_, held_);
  EXPECT_EQ(measured.orientation_stddev, 2e-4);
  EXPECT_EQ(measured.torque_stddev, 5e-5);
  EXPECT_EQ(measured.joint_stddev, Eigen::Vector3d(1e-5, 0.0, 3e-5));
}

TEST_F(MeasuredNoiseTest, IsAsExpectedWhereNoSampleTellsIt) {
  options_.joint_stddev = {1e-4, 2e-4, 3e-4};
  // A sample that was made without a standard deviation, and a torque that it does not have.
  held_ = {tracked(0.0)};
  held_.front().torque_stddev = 1e-5;
  const PosePlanOptions measured = withMeasuredNoise(options_, held_);
  EXPECT_EQ(measured.orientation_stddev, options_.orientation_stddev);
  EXPECT_EQ(measured.torque_stddev, options_.torque_stddev);
  EXPECT_EQ(measured.joint_stddev, options_.joint_stddev);
}

TEST_F(MeasuredNoiseTest, MakesAPlanPromiseWhatTheMachineGives) {
  options_.max_poses = 10;
  const double expected = planPoses(problem_, options_).worst_stddev;
  const std::vector<Sample> quiet = {tracked(options_.orientation_stddev / kQuieter),
                                     torqueOf(options_.torque_stddev / kQuieter)};
  const double promised = planPoses(problem_, withMeasuredNoise(options_, quiet)).worst_stddev;
  EXPECT_NEAR(promised, expected / kQuieter, 1e-2 * expected);
}

}  // namespace
}  // namespace sac
