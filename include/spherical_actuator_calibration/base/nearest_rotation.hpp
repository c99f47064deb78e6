#pragma once

#include <Eigen/Core>

namespace sac {

/// The rotation R nearest to a matrix, which makes tr(Rᵀ matrix) largest (Kabsch): of a sum of
/// rotations their chordal mean; of Σ b aᵀ the one that turns vectors a best into b. One of several
/// where two singular values are zero.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix);

/// X and Z that bring rotations A to B.
struct RotationPair {
  Eigen::Matrix3d X = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d Z = Eigen::Matrix3d::Identity();
};

/// Pairs of rotations (A, B) between two frames on either side, X A = B Z: as of a marker seen by a
/// tracker and of the rotor by its joints.
class RotationPairSum {
 public:
  void add(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B);
  /// X and Z that make Σ tr((X A)ᵀ B Z) nearly largest: exactly without noise, from pairs that turn
  /// about two axes or more.
  RotationPair nearest() const;

 private:
  Eigen::Matrix<double, 9, 9> sum_ = Eigen::Matrix<double, 9, 9>::Zero();
};

}  // namespace sac
