#include "spherical_actuator_calibration/study/free_axis_calibration.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace sac {
namespace {

FreeAxes axesOf(const Actuator& actuator) {
  const JointGeometry joints = jointGeometry(actuator.joints);
  return {joints.axes, joints.offsets};
}

double deviation(const FreeAxes& one, const FreeAxes& other) {
  return std::max((one.axes - other.axes).cwiseAbs().maxCoeff(),
                  (one.offsets - other.offsets).cwiseAbs().maxCoeff());
}

class FreeAxisCalibration : public ::testing::Test {
 protected:
  FreeAxisPath run(JacobianUse use, int iterations) {
    scenarios::Generator generator(3);
    const std::vector<Sample> samples = scenarios::orientationSamples(
        scenarios::paperTruth(), scenarios::randomPoses(6, 0.6, generator), 0.0, 1e-3, generator);
    return calibrateFreeAxes(samples, axesOf(scenarios::paperNominal()), use, iterations);
  }

  const FreeAxes truth_ = axesOf(scenarios::paperTruth());
};

TEST_F(FreeAxisCalibration, UnitAxesTurnAsThoseOfTheJoint) {
  const Actuator truth = scenarios::paperTruth();
  const Eigen::Vector3d q(0.3, -0.2, 1.1);
  EXPECT_LT((rotorOrientation(truth_, q) - rotorOrientation(jointGeometry(truth.joints), q)).norm(),
            1e-14);
}

TEST_F(FreeAxisCalibration, GaussNewtonConvergesQuadratically) {
  const FreeAxisPath path = run(JacobianUse::kEveryIteration, 5);
  ASSERT_EQ(path.joints.size(), 6U);
  ASSERT_EQ(path.errors.size(), 6U);
  EXPECT_LT(deviation(path.joints[2], truth_), 1e-4);
  EXPECT_LT(deviation(path.joints[3], truth_), 1e-9);
  EXPECT_LT(path.errors[4], 1e-13);
}

TEST_F(FreeAxisCalibration, TheChordMethodConvergesLinearlyAsInThePapersTable4) {
  const FreeAxisPath path = run(JacobianUse::kOnce, 8);
  EXPECT_EQ(path.errors[1], run(JacobianUse::kEveryIteration, 1).errors[1]);
  const double second = deviation(path.joints[2], truth_);
  const double third = deviation(path.joints[3], truth_);
  EXPECT_GT(third, 1e-8);
  EXPECT_LT(third, 0.2 * second);
  EXPECT_LT(deviation(path.joints[8], truth_), 1e-10);
}

TEST_F(FreeAxisCalibration, TwoOrientationsFitWithoutBeingTold) {
  scenarios::Generator generator(3);
  const std::vector<Sample> samples = scenarios::orientationSamples(
      scenarios::paperTruth(), scenarios::randomPoses(2, 0.6, generator), 1e-3, 1e-3, generator);
  const FreeAxisPath path = calibrateFreeAxes(
      samples, axesOf(scenarios::paperNominal()), JacobianUse::kEveryIteration, 8);
  // Six equations, twelve unknowns: the noise is fitted, and the axes are wrong.
  EXPECT_LT(path.errors.back(), 1e-12);
  EXPECT_GT(deviation(path.joints.back(), truth_), 1e-3);
}

}  // namespace
}  // namespace sac
