#include "spherical_actuator_calibration/estimation/information_factor.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <gtest/gtest.h>

#include "extreme_eigenvalue.hpp"
#include "observability.hpp"

namespace sac {
namespace {

/// As of samples of single coils: each meets joints and poles, which come first, and itself.
Eigen::MatrixXd coilInformation(Eigen::Index coils, Eigen::Index border, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const Eigen::Index size = border + 2 * coils;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < coils; ++j) {
    for (int sample = 0; sample < 4; ++sample) {
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, size);
      for (Eigen::Index row = 0; row < 3; ++row) {
        for (Eigen::Index p = 0; p < border; ++p) {
          J(row, p) = normal(generator);
        }
        J(row, border + 2 * j) = normal(generator);
        J(row, border + 2 * j + 1) = normal(generator);
      }
      information += J.transpose() * J;
    }
  }
  return information;
}

TEST(InformationFactor, OfIslandsIsThatOfTheWhole) {
  const Eigen::MatrixXd information = coilInformation(120, 20, 1);
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(information.rows(), -1.0, 2.0);
  const InformationFactor factor(information);
  ASSERT_TRUE(factor.isPositive());
  EXPECT_TRUE(factor.hasIslands());
  const Eigen::MatrixXd inverse = information.inverse();
  EXPECT_LT((factor.inverse() - inverse).norm(), 1e-11 * inverse.norm());
  EXPECT_LT((factor.solve(right) - inverse * right).norm(), 1e-11 * (inverse * right).norm());

  const Eigen::VectorXd more = Eigen::VectorXd::LinSpaced(information.rows(), 0.1, 3.0);
  const Eigen::MatrixXd larger = (information + Eigen::MatrixXd(more.asDiagonal())).inverse();
  EXPECT_LT((InformationFactor(information, more).inverse() - larger).norm(),
            1e-11 * larger.norm());
}

TEST(InformationFactor, HalvesMultiplyAsByTheInverse) {
  for (const Eigen::Index coils : {10, 120}) {  // as a whole, and by islands
    const Eigen::MatrixXd information = coilInformation(coils, 20, 6);
    const InformationFactor factor(information);
    const Eigen::MatrixXd inverse = information.inverse();
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(information.rows(), 2);
    columns.col(0) = Eigen::VectorXd::LinSpaced(information.rows(), -1.0, 2.0);
    columns.col(1).segment(30, 2) << 1.0, -2.0;  // of one coil
    const Eigen::MatrixXd expected = columns.transpose() * inverse * columns;
    const Eigen::MatrixXd halves = factor.half(columns);
    EXPECT_LT((halves.transpose() * halves - expected).norm(), 1e-11 * expected.norm());
    const Eigen::MatrixXd of_one_coil = factor.half(columns.rightCols(1));
    EXPECT_LT((of_one_coil - halves.rightCols(1)).norm(), 1e-11 * halves.norm());
  }
}

TEST(InformationFactor, FindsIslandsInAnyOrder) {
  const Eigen::MatrixXd sorted = coilInformation(120, 20, 2);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(sorted.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  const Eigen::MatrixXd information = sorted(order, order);
  const InformationFactor factor(information);
  EXPECT_TRUE(factor.hasIslands());
  const Eigen::MatrixXd product = factor.inverse() * information;
  EXPECT_TRUE(product.isIdentity(1e-9));
}

TEST(InformationFactor, CoilsThatMeetAreFactorisedAsAWhole) {
  Eigen::MatrixXd information = coilInformation(120, 20, 4);
  const Eigen::Index first = 20;
  for (Eigen::Index p = first; p + 2 < information.rows(); ++p) {
    information(p, p + 2) = information(p + 2, p) = 0.01;
  }
  const InformationFactor factor(information);
  EXPECT_FALSE(factor.hasIslands());
  EXPECT_TRUE((factor.inverse() * information).isIdentity(1e-9));
}

TEST(InformationFactor, TellsWhatIsNotPositive) {
  Eigen::MatrixXd information = coilInformation(120, 20, 5);
  EXPECT_TRUE(leavesNothingOpen(information, 1e3));
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(information).eigenvalues()[0];
  EXPECT_TRUE(leavesNothingOpen(information, 1.001 / std::sqrt(smallest)));
  EXPECT_FALSE(leavesNothingOpen(information, 0.999 / std::sqrt(smallest)));
  // A coil that no sample excites.
  information.middleRows(40, 2).setZero();
  information.middleCols(40, 2).setZero();
  EXPECT_FALSE(InformationFactor(information).isPositive());
  EXPECT_FALSE(leavesNothingOpen(information, 1e3));
}

TEST(InformationFactor, ConditionNumbersAreThoseOfAllEigenvalues) {
  for (const unsigned seed : {6U, 7U, 8U}) {
    const Eigen::MatrixXd information = coilInformation(150, 12, seed);
    const double all = judgeInformation(information, 1e3).identified_condition_number;
    EXPECT_NEAR(identifiedConditionNumber(information, 1e3) / all, 1.0, 1e-9);
  }
}

TEST(LargestEigenvalue, IsFoundAmongEqualOnes) {
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(200, 0.5, 3.0);
  values.tail<3>().setConstant(4.0);
  const double largest = largestEigenvalue(
      [&](const Eigen::VectorXd& v) { return Eigen::VectorXd(values.cwiseProduct(v)); }, 200);
  EXPECT_NEAR(largest, 4.0, 4e-12);
}

}  // namespace
}  // namespace sac
