#include "spherical_actuator_calibration/planning/measured_noise.hpp"

#include <gtest/gtest.h>

#include "planning_fixture.hpp"

namespace sac {
namespace {

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
