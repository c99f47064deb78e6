#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

/// Cholesky factor of an information matrix. Where there are many coordinates and most of them meet
/// few others, as those of a coil meet only joints, poles and each other, it is made island by
/// island: the islands are eliminated one after the other, and what is left of the coordinates that
/// meet many, the border, is factorised as a whole (Schur complement). Its cost then grows with the
/// number of islands, not with its cube. Few coordinates are one border.
class InformationFactor {
 public:
  explicit InformationFactor(const Eigen::MatrixXd& information)
      : InformationFactor(information, Eigen::VectorXd::Zero(information.rows())) {}
  /// Of information + diag(`more`).
  InformationFactor(const Eigen::MatrixXd& information, const Eigen::VectorXd& more);

  /// False: the matrix is not positive definite, and there is no factor.
  bool isPositive() const { return rest_.isPositive(); }
  /// False: the matrix was factorised as a whole.
  bool hasIslands() const { return !islands_.empty(); }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd inverse() const;
  /// Y for columns C so that YᵀY' = CᵀN⁻¹C', with N the information. Islands where C is zero cost
  /// nothing.
  Eigen::MatrixXd half(const Eigen::MatrixXd& columns) const;

 private:
  /// Coordinates that meet each other and the border, but no others.
  struct Island {
    std::vector<Eigen::Index> places;
    Eigen::MatrixXd half;       ///< L⁻¹ of its own block D = LLᵀ
    Eigen::MatrixXd inverse;    ///< D⁻¹
    Eigen::MatrixXd to_border;  ///< D⁻¹B
  };

  bool findIslands(const Eigen::MatrixXd& information);
  bool factorise(const Eigen::MatrixXd& information, const Eigen::VectorXd& more);
  void takeIsland(const Eigen::MatrixXd& information, std::size_t first);

  std::vector<Eigen::Index> border_;
  std::vector<Island> islands_;
  std::vector<int> state_;  ///< per coordinate, while islands are found
  Cholesky rest_;
};

}  // namespace sac
