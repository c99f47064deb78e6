#include "spherical_actuator_calibration/base/nearest_rotation.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace sac {

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d product = svd.matrixU() * svd.matrixV().transpose();
  const Eigen::Vector3d signs(1.0, 1.0, product.determinant() < 0.0 ? -1.0 : 1.0);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

// vec(B Z Aᵀ) = (A ⊗ B) vec(Z), so that the sum of traces is vec(X)ᵀ (Σ A ⊗ B) vec(Z).
void RotationPairSum::add(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  for (Eigen::Index a = 0; a < 3; ++a) {
    for (Eigen::Index b = 0; b < 3; ++b) {
      sum_.block<3, 3>(3 * a, 3 * b) += A(a, b) * B;
    }
  }
}

RotationPair RotationPairSum::nearest() const {
  using Matrix9d = Eigen::Matrix<double, 9, 9>;
  using Vector9d = Eigen::Matrix<double, 9, 1>;
  const Eigen::JacobiSVD<Matrix9d> svd(sum_, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector9d left = svd.matrixU().col(0);
  const Vector9d right = svd.matrixV().col(0);
  const Eigen::Map<const Eigen::Matrix3d> X(left.data());
  const Eigen::Map<const Eigen::Matrix3d> Z(right.data());
  const double sign = X.determinant() < 0.0 ? -1.0 : 1.0;
  return {nearestRotation(sign * X), nearestRotation(sign * Z)};
}

}  // namespace sac
