#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

TEST(ParameterSpace, CountsAndNamesEveryParameter) {
  const ParameterSpace space(scenarios::paperNominal());
  EXPECT_EQ(space.size(), 73);
  EXPECT_EQ(space.name(0), "joint_1/offset");
  EXPECT_EQ(space.name(1), "joint_1/axis_u");
  EXPECT_EQ(space.name(8), "joint_3/axis_v");
  EXPECT_EQ(space.name(9), "pole_1/polar");
  EXPECT_EQ(space.name(24), "pole_8/azimuth");
  EXPECT_EQ(space.name(25), "coil_1/polar");
  EXPECT_EQ(space.name(72), "coil_24/azimuth");
}

TEST(ParameterSpace, WithoutJointsItBeginsWithThePoles) {
  const ParameterSpace space(scenarios::reactionSphere());
  EXPECT_EQ(space.joints(), 0U);
  EXPECT_EQ(space.size(), 56);
  EXPECT_EQ(space.name(0), "pole_1/polar");
  EXPECT_EQ(space.name(16), "coil_1/polar");
  EXPECT_EQ(space.name(55), "coil_20/azimuth");
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(space.size(), -0.02, 0.02);
  const Actuator moved = space.actuatorAt(x);
  EXPECT_FALSE(moved.has_joints);
  EXPECT_EQ(moved.joints[0].axis, Eigen::Vector3d::UnitX());
  EXPECT_LT((space.coordinatesOf(moved) - x).norm(), 1e-14);
}

TEST(ParameterSpace, CoordinatesAndActuatorsAreInverse) {
  const ParameterSpace space(scenarios::paperNominal());
  const Actuator truth = scenarios::paperTruth();
  const Eigen::VectorXd x = space.coordinatesOf(truth);
  EXPECT_LT((space.coordinatesOf(space.actuatorAt(x)) - x).norm(), 1e-14);
  const Actuator back = space.actuatorAt(x);
  EXPECT_NEAR(back.poles[7].azimuth, truth.poles[7].azimuth, 1e-15 * 8);
  EXPECT_NEAR(back.joints[1].offset, truth.joints[1].offset, 1e-17);
  EXPECT_LT((back.joints[0].axis - truth.joints[0].axis).norm(), 1e-15);
}

TEST(ParameterSpace, ZeroIsNominalToTheLastBit) {
  const ParameterSpace space(scenarios::paperNominal());
  const Actuator back = space.actuatorAt(Eigen::VectorXd::Zero(space.size()));
  for (std::size_t j = 0; j < back.coils.size(); ++j) {
    EXPECT_EQ(back.coils[j].polar, space.nominal().coils[j].polar);
    EXPECT_EQ(back.coils[j].azimuth, space.nominal().coils[j].azimuth);
  }
}

TEST(ParameterSpace, StandardDeviationsOfAnglesFollowTheAzimuthsShrinkingCircle) {
  Actuator actuator = scenarios::paperNominal();
  actuator.coils[0].polar = 1.2;
  const ParameterSpace space(actuator);
  const Eigen::MatrixXd covariance = 1e-6 * Eigen::MatrixXd::Identity(space.size(), space.size());
  const Eigen::VectorXd stddevs =
      space.reportedStddevs(Eigen::VectorXd::Zero(space.size()), covariance);
  EXPECT_NEAR(stddevs[space.coil(0)], 1e-3, 1e-12);
  EXPECT_NEAR(stddevs[space.coil(0) + 1], 1e-3 / std::cos(1.2), 1e-12);
}

TEST(ParameterSpace, StandardDeviationsHoldAwayFromNominalToo) {
  // Against sampling: the reported deviation is that of the reported value.
  Actuator actuator = scenarios::paperNominal();
  actuator.coils[0].polar = 1.0;
  const ParameterSpace space(actuator);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(space.size());
  x[space.coil(0)] = 0.3;
  x[space.coil(0) + 1] = 0.4;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(space.size(), space.size());
  Eigen::Matrix2d block;
  block << 4e-8, 1e-8, 1e-8, 9e-8;
  covariance.block<2, 2>(space.coil(0), space.coil(0)) = block;
  const Eigen::Matrix2d root = block.llt().matrixL();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  const Eigen::VectorXd center = space.reportedValues(x);
  for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)}) {
    Eigen::VectorXd moved = x;
    moved.segment<2>(space.coil(0)) += root * direction;
    squares += (space.reportedValues(moved) - center).segment<2>(space.coil(0)).cwiseAbs2();
  }
  const Eigen::VectorXd stddevs = space.reportedStddevs(x, covariance);
  EXPECT_NEAR(stddevs[space.coil(0)], std::sqrt(squares[0]), 1e-6);
  EXPECT_NEAR(stddevs[space.coil(0) + 1], std::sqrt(squares[1]), 1e-6);
}

TEST(ParameterSpace, AnAxisAtTheTopStaysFinite) {
  Actuator actuator = scenarios::paperNominal();
  actuator.coils[0].polar = 1.5707963267948966;
  const ParameterSpace space(actuator);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(space.size());
  const Eigen::MatrixXd covariance = 1e-6 * Eigen::MatrixXd::Identity(space.size(), space.size());
  EXPECT_TRUE(space.reportedStddevs(x, covariance).allFinite());
  x[space.coil(0) + 1] = 0.01;  // a lean towards growing azimuth
  const Actuator moved = space.actuatorAt(x);
  EXPECT_LT((axisFromAngles(moved.coils[0].polar, moved.coils[0].azimuth) -
             space.coilChart(0).axis(0.0, 0.01))
                .norm(),
            1e-9);
}

TEST(ParameterSpace, RefusesAnActuatorOfAnotherSize) {
  const ParameterSpace space(scenarios::paperNominal());
  Actuator other = scenarios::paperNominal();
  other.coils.pop_back();
  EXPECT_THROW(space.coordinatesOf(other), DataError);
}

}  // namespace
}  // namespace sac
