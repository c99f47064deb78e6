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

}  // namespace
}  // namespace sac
