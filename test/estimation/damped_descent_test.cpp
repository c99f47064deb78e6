#include "spherical_actuator_calibration/estimation/damped_descent.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

/// Squares of (10 (y − x²), 1 − x), a bent valley down to (1, 1).
struct Valley {
  using Point = Eigen::Vector2d;

  static double cost(const Point& at) {
    return std::pow(10.0 * (at[1] - at[0] * at[0]), 2) + std::pow(1.0 - at[0], 2);
  }

  NormalEquations normalEquations(const Point& at) {
    ++linearised;
    const Eigen::Vector2d residual(10.0 * (at[1] - at[0] * at[0]), 1.0 - at[0]);
    Eigen::Matrix2d J;
    J << -20.0 * at[0], 10.0, -1.0, 0.0;
    return {cost(at), J.transpose() * residual, J.transpose() * J};
  }

  static Point moved(const Point& at, const Eigen::VectorXd& step) { return at + step; }
  static double nothing(const Point& /*at*/) { return 1e-12; }

  int linearised = 0;
};

Eigen::Vector2d farOff() {
  return {-1.2, 1.0};
}

TEST(DampedDescent, GoesDownABentValleyToItsEnd) {
  Valley valley;
  std::vector<Eigen::Vector2d> path{farOff()};
  EXPECT_EQ(descend(valley, {}, path), Termination::kConverged);
  EXPECT_LT((path.back() - Eigen::Vector2d::Ones()).norm(), 1e-12);
  EXPECT_EQ(path.size(), static_cast<std::size_t>(valley.linearised) + 1);
  for (std::size_t n = 1; n < path.size(); ++n) {
    EXPECT_LE(Valley::cost(path[n]), Valley::cost(path[n - 1])) << n;
  }
}

TEST(DampedDescent, EndsAfterAsManyIterationsAsItMay) {
  Valley valley;
  DescentOptions options;
  options.max_iterations = 3;
  std::vector<Eigen::Vector2d> path{farOff()};
  EXPECT_EQ(descend(valley, options, path), Termination::kIterationLimit);
  EXPECT_EQ(path.size(), 4U);
}

/// A valley of which a fence lets nobody see the other side.
struct Fenced : Valley {
  static double cost(const Point& at) {
    return at[0] > 0.5 ? std::numeric_limits<double>::quiet_NaN() : Valley::cost(at);
  }
};

TEST(DampedDescent, EndsBeforeWhatHasNoCost) {
  Fenced fenced;
  DescentOptions options;
  options.max_iterations = 1000;
  std::vector<Eigen::Vector2d> path{farOff()};
  descend(fenced, options, path);
  EXPECT_TRUE(std::isfinite(Fenced::cost(path.back())));
  EXPECT_GT(path.back()[0], 0.49);
}

/// One coordinate, by its residual, where 1e-5 is nothing.
struct Line {
  using Point = Eigen::VectorXd;

  double cost(const Point& at) const { return std::pow(residual(at[0]), 2); }
  NormalEquations normalEquations(const Point& at) const {
    const double r = residual(at[0]);
    const double slope = (residual(at[0] + 1e-9) - r) / 1e-9;
    return {r * r,
            Eigen::VectorXd::Constant(1, slope * r),
            Eigen::MatrixXd::Constant(1, 1, slope * slope)};
  }
  static Point moved(const Point& at, const Eigen::VectorXd& step) { return at + step; }
  static double nothing(const Point& /*at*/) { return 1e-5; }

  double (*residual)(double);
};

TEST(DampedDescent, DoesNotTakeADampedStepForTheLastOne) {
  // Each step of Gauss and Newton goes far beyond the minimum at −1/8000.
  Line line{[](double x) { return 1.0 + x + (x > 0.0 ? 0.0 : 4000.0 * x * x); }};
  std::vector<Eigen::VectorXd> path{Eigen::VectorXd::Ones(1)};
  descend(line, {}, path);
  EXPECT_NEAR(path.back()[0], -1.0 / 8000.0, 2e-5);
}

TEST(DampedDescent, TriesItsLastStepWhereTheCostIsNotSmooth) {
  Line line{[](double x) { return x > 1e-3 ? x : std::numeric_limits<double>::quiet_NaN(); }};
  std::vector<Eigen::VectorXd> path{Eigen::VectorXd::Ones(1)};
  DescentOptions options;
  options.first_damping = 1e-3;  // the first step ends just before the fence
  descend(line, options, path);
  EXPECT_TRUE(std::isfinite(line.cost(path.back()))) << path.back();
}

/// Nothing tells of the second coordinate.
TEST(DampedDescent, LeavesACoordinateThatNothingTells) {
  struct Trough : Valley {
    static double cost(const Point& at) { return at[0] * at[0]; }
    static NormalEquations normalEquations(const Point& at) {
      return {cost(at), Eigen::Vector2d(at[0], 0.0), Eigen::Vector2d(1.0, 0.0).asDiagonal()};
    }
  } trough;
  std::vector<Eigen::Vector2d> path{{3.0, 2.0}};
  EXPECT_EQ(descend(trough, {}, path), Termination::kConverged);
  EXPECT_NEAR(path.back()[0], 0.0, 1e-12);
  EXPECT_EQ(path.back()[1], 2.0);
}

TEST(DampedDescent, SaysWhereNothingIsFinite) {
  struct Nowhere : Valley {
    static NormalEquations normalEquations(const Point& /*at*/) {
      const double nan = std::numeric_limits<double>::quiet_NaN();
      return {nan, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity()};
    }
  } nowhere;
  std::vector<Eigen::Vector2d> path{farOff()};
  EXPECT_EQ(descend(nowhere, {}, path), Termination::kNumericalFailure);
  EXPECT_EQ(path.size(), 1U);
}

}  // namespace
}  // namespace sac
