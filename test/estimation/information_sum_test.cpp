#include <Eigen/Core>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

constexpr Eigen::Index kUnknowns = 4;
constexpr Eigen::Index kResiduals = 6;

/// The sums over J and r, when they are told in another way.
template <typename Add>
void expectToldAs(const Eigen::MatrixXd& J, const Eigen::VectorXd& r, const Add& add) {
  InformationSum sum(kUnknowns);
  add(sum);
  EXPECT_LT((sum.information() - J.transpose() * J).norm(), 1e-12);
  EXPECT_LT((sum.gradient() - J.transpose() * r).norm(), 1e-12);
  EXPECT_NEAR(sum.squaredMisfit(), r.squaredNorm(), 1e-12);
}

TEST(InformationSum, ExpressionsCountAsTheirValues) {
  const Eigen::MatrixXd J = Eigen::MatrixXd::Random(kResiduals, kUnknowns);
  const Eigen::VectorXd r = Eigen::VectorXd::Random(kResiduals);
  expectToldAs(J, r, [&](InformationSum& sum) { sum.addDense(J, r); });
  expectToldAs(3.0 * J, 3.0 * r, [&](InformationSum& sum) { sum.addDense(3.0 * J, 3.0 * r); });
  expectToldAs(3.0 * J, 3.0 * r, [&](InformationSum& sum) { sum.addDense(J, r, 9.0); });
  expectToldAs(-J, r, [&](InformationSum& sum) { sum.addDense(-J, r); });
  expectToldAs(J.topRows<3>(), r.head<3>(), [&](InformationSum& sum) {
    sum.addDense(J.topRows<3>(), r.head<3>());
  });
  const Eigen::MatrixXd turned = J.transpose();
  expectToldAs(3.0 * J, r, [&](InformationSum& sum) { sum.addDense(3.0 * turned.transpose(), r); });
  expectToldAs(J / 3.0, r, [&](InformationSum& sum) { sum.addDense(J / 3.0, r); });
}

// As of orientations that are all outliers. Of many unknowns, where products are made of blocks.
TEST(InformationSum, NothingIsToldByNoResiduals) {
  InformationSum sum(Eigen::MatrixXd(Eigen::MatrixXd::Identity(100, 100)));
  const Eigen::MatrixXd J(6, 100);
  const Eigen::VectorXd r(6);
  sum.addDense(J.topRows(0), r.head(0));
  sum.addDense(Eigen::MatrixXd(0, 100), Eigen::VectorXd(0));
  EXPECT_EQ(sum.information(), Eigen::MatrixXd(Eigen::MatrixXd::Identity(100, 100)));
  EXPECT_EQ(sum.gradient(), Eigen::VectorXd(Eigen::VectorXd::Zero(100)));
}

}  // namespace
}  // namespace sac
