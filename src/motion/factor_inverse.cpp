#include "factor_inverse.hpp"

namespace sac {
namespace {

Eigen::MatrixXd inverseOfTriangle(const Eigen::Ref<const Eigen::MatrixXd>& L) {
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(L.rows(), L.cols());
  L.triangularView<Eigen::Lower>().solveInPlace(inverse);
  return inverse;
}

}  // namespace

Eigen::MatrixXd inverseOfSquare(const Eigen::MatrixXd& L) {
  const Eigen::Index all = L.rows();
  const Eigen::Index first = all / 2;
  const Eigen::Index last = all - first;
  // L⁻¹ = [R₁ 0; −R₂ L₂₁ R₁  R₂]
  const Eigen::MatrixXd R_1 = inverseOfTriangle(L.topLeftCorner(first, first));
  const Eigen::MatrixXd R_2 = inverseOfTriangle(L.bottomRightCorner(last, last));
  Eigen::MatrixXd below(last, all);
  below.rightCols(last) = R_2;
  const Eigen::MatrixXd crossed = L.bottomLeftCorner(last, first) * R_1;
  below.leftCols(first).noalias() = -(R_2.triangularView<Eigen::Lower>() * crossed);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(all, all);
  inverse.selfadjointView<Eigen::Lower>().rankUpdate(below.transpose());
  inverse.topLeftCorner(first, first).selfadjointView<Eigen::Lower>().rankUpdate(R_1.transpose());
  inverse.triangularView<Eigen::StrictlyUpper>() = inverse.transpose();
  return inverse;
}

}  // namespace sac
