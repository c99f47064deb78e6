#include "spherical_actuator_calibration/base/axis_chart.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "support/numeric_jacobian.hpp"

namespace sac {
namespace {

std::vector<AxisChart> charts() {
  return {AxisChart::aroundAxis(Eigen::Vector3d::UnitX()),
          AxisChart::aroundAxis(Eigen::Vector3d(0.2, -0.9, 0.3)),
          AxisChart::aroundAngles(0.26, 5.5),
          AxisChart::aroundAngles(1.5707963267948966, 0.7)};
}

TEST(AxisChart, AxesStayUnitAndCoordinatesComeBack) {
  for (const AxisChart& chart : charts()) {
    for (const Eigen::Vector2d& uv : {Eigen::Vector2d(0.0, 0.0),
                                      Eigen::Vector2d(1e-9, -2e-9),
                                      Eigen::Vector2d(0.02, 0.01),
                                      Eigen::Vector2d(-1.0, 2.5)}) {
      const Eigen::Vector3d axis = chart.axis(uv[0], uv[1]);
      EXPECT_NEAR(axis.norm(), 1.0, 1e-15);
      EXPECT_LT((chart.coordinates(axis) - uv).norm(), 1e-14);
    }
  }
}

TEST(AxisChart, CoordinatesAreDistancesOnTheSphere) {
  for (const AxisChart& chart : charts()) {
    const Eigen::Vector3d axis = chart.axis(0.3, 0.4);
    EXPECT_NEAR(std::acos(axis.dot(chart.base())), 0.5, 1e-14);
  }
}

TEST(AxisChart, JacobianIsTheDerivative) {
  for (const AxisChart& chart : charts()) {
    const auto axis = [&](const Eigen::VectorXd& uv) -> Eigen::VectorXd {
      return chart.axis(uv[0], uv[1]);
    };
    for (const Eigen::Vector2d& uv :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.02, -0.01), Eigen::Vector2d(0.7, 1.1)}) {
      EXPECT_LT((chart.jacobian(uv[0], uv[1]) - numericJacobian(axis, uv)).cwiseAbs().maxCoeff(),
                1e-11);
    }
  }
}

TEST(AxisChart, CoordinateAxesHaveTheCyclicBasis) {
  const AxisChart chart = AxisChart::aroundAxis(Eigen::Vector3d::UnitY());
  EXPECT_EQ(chart.basisU(), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(chart.basisV(), Eigen::Vector3d::UnitX());
}

TEST(AxisChart, AngleBasisPointsToGrowingAngles) {
  const AxisChart chart = AxisChart::aroundAngles(0.3, 1.0);
  const double step = 1e-7;
  const AxisChart higher = AxisChart::aroundAngles(0.3 + step, 1.0);
  const AxisChart further = AxisChart::aroundAngles(0.3, 1.0 + step);
  EXPECT_LT(((higher.base() - chart.base()) / step - chart.basisU()).norm(), 1e-6);
  EXPECT_LT(((further.base() - chart.base()) / step - std::cos(0.3) * chart.basisV()).norm(), 1e-6);
}

}  // namespace
}  // namespace sac
