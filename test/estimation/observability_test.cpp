#include "observability.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kLimit = 0.05;

/// Of a direction that is known to `stddev`, and all across it to 1e-4.
Eigen::MatrixXd informationWith(const Eigen::VectorXd& direction, double stddev) {
  const Eigen::VectorXd v = direction.normalized();
  const Eigen::MatrixXd along = v * v.transpose();
  return along / (stddev * stddev) + 1e8 * (Eigen::MatrixXd::Identity(v.size(), v.size()) - along);
}

TEST(Observability, ADirectionIsOpenWhereItLeavesACoordinateUnknown) {
  const Observability open =
      judgeInformation(informationWith(Eigen::Vector2d(1.0, 1.0), 0.08), kLimit);
  EXPECT_EQ(open.open_directions.cols(), 1);
  EXPECT_EQ(open.weak.size(), 2U);
  EXPECT_EQ(open.rank, 1);
  EXPECT_NEAR(open.identified_condition_number, 1.0, 1e-9);
}

TEST(Observability, ATurnOfTheWholeMachineIsKnownAsWellAsEachCoordinate) {
  // 0.028 rad of each of ten.
  const Eigen::VectorXd turn = Eigen::VectorXd::Ones(10);
  const Observability known =
      judgeInformation(informationWith(turn, 0.028 * std::sqrt(10.0)), kLimit);
  EXPECT_EQ(known.open_directions.cols(), 0);
  EXPECT_TRUE(known.weak.empty());
  EXPECT_EQ(known.rank, 10);
  EXPECT_NEAR(known.identified_condition_number, 280.0 * std::sqrt(10.0), 1.0);
  EXPECT_EQ(judgeInformation(informationWith(turn, 0.051 * std::sqrt(10.0)), kLimit).rank, 9);
}

TEST(Observability, DirectionsTogetherLeaveOpenWhatEachAloneDoesNot) {
  // Both known to 0.06: by each the first coordinate to 0.0424, by both to 0.06.
  const double least = 1.0 / (0.06 * 0.06);
  Eigen::MatrixXd information = 1e8 * Eigen::MatrixXd::Identity(4, 4);
  information.topLeftCorner<2, 2>() = least * Eigen::Matrix2d::Identity();
  EXPECT_EQ(judgeInformation(information, kLimit).open_directions.cols(), 2);
  const double s = std::sqrt(0.5);
  Eigen::Matrix2d turn;
  turn << s, -s, s, s;
  const Eigen::Matrix2d values = Eigen::Vector2d(least, 1.0001 * least).asDiagonal();
  information.topLeftCorner<2, 2>() = turn * values * turn.transpose();
  const Observability both = judgeInformation(information, kLimit);
  EXPECT_EQ(both.open_directions.cols(), 2);
  EXPECT_EQ(both.rank, 2);
}

TEST(Observability, AnOpenDirectionTakesNoKnownOneWithIt) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(11, 11);
  information.topLeftCorner(10, 10) =
      informationWith(Eigen::VectorXd::Ones(10), 0.028 * std::sqrt(10.0));
  const Observability one = judgeInformation(information, kLimit);
  ASSERT_EQ(one.open_directions.cols(), 1);
  ASSERT_EQ(one.weak.size(), 1U);
  EXPECT_EQ(one.weak[0], 10);
  EXPECT_EQ(one.rank, 10);
}

}  // namespace
}  // namespace sac
