#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/linearization.hpp"

namespace sac {

/// F coordinates chosen out of P.
class ChosenCoordinates {
 public:
  /// `chosen`: ascending, each below `all`.
  ChosenCoordinates(Eigen::Index all, const std::vector<Eigen::Index>& chosen);
  static ChosenCoordinates all(Eigen::Index size);

  Eigen::Index size() const { return size_; }
  /// Place of a coordinate among the chosen ones, or −1.
  Eigen::Index place(Eigen::Index coordinate) const {
    return places_[static_cast<std::size_t>(coordinate)];
  }
  /// Per coordinate: it is not chosen.
  std::vector<bool> others() const;

 private:
  std::vector<Eigen::Index> places_;
  Eigen::Index size_;
};

/// W with WᵀW = S⁻¹ for the covariance S of an observation, lower triangular.
Eigen::Matrix3d whiteningOf(const Eigen::Matrix3d& covariance);

/// W of an observation that is kept for long: the numbers of its triangle alone.
class Whitening {
 public:
  Whitening() = default;
  /// Precondition: lower triangular.
  Whitening(const Eigen::Matrix3d& W)  // NOLINT(google-explicit-constructor)
      : lower_{W(0, 0), W(1, 0), W(1, 1), W(2, 0), W(2, 1), W(2, 2)} {}

  operator Eigen::Matrix3d() const {  // NOLINT(google-explicit-constructor)
    Eigen::Matrix3d W;
    W << lower_[0], 0.0, 0.0, lower_[1], lower_[2], 0.0, lower_[3], lower_[4], lower_[5];
    return W;
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& residual) const {
    return Eigen::Matrix3d(*this) * residual;
  }

 private:
  std::array<double, 6> lower_ = {};  ///< row by row
};

/// One observation in units of its noise, linearised in chosen coordinates: W r(x + δ) ≈ residual +
/// Σ jacobian.col(k) δ[columns[k]].
struct WhitenedObservation {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  std::vector<Eigen::Index> columns;  ///< places among the chosen coordinates, ascending
  /// Of these columns; the others are zero. Storage that is reused may have more behind them.
  Eigen::Matrix3Xd jacobian;

  /// M Jᵀ (rows × 3) for a matrix of F columns.
  Eigen::Matrix<double, Eigen::Dynamic, 3> timesTransposed(const Eigen::MatrixXd& M) const;
  /// J M for a matrix of F rows.
  Eigen::Matrix3d times(const Eigen::Matrix<double, Eigen::Dynamic, 3>& M) const;
};

/// Fills `out`, whose storage is reused. `whitening`: W.
void whiten(const LinearizedObservation& linear,
            const Eigen::Matrix3d& whitening,
            const ChosenCoordinates& chosen,
            WhitenedObservation& out);

/// Sums over independent observations: their information, gradient and squared misfit.
class InformationSum {
 public:
  explicit InformationSum(Eigen::Index size);
  /// Starts with what is known already, F×F.
  explicit InformationSum(Eigen::MatrixXd known);

  /// `weight`: of the observation beside its noise.
  void add(const WhitenedObservation& observation, double weight = 1.0) {
    addLeading(observation, observation.columns.size(), weight);
  }
  /// The same by its first `count` columns, as if there were no others.
  void addLeading(const WhitenedObservation& observation, std::size_t count, double weight);

  /// n ≥ 0 residuals at once that may depend on all coordinates. `jacobian` n×F, `residual` n: in
  /// units of their noise.
  template <typename Jacobian, typename Residual>
  void addDense(const Eigen::MatrixBase<Jacobian>& jacobian,
                const Eigen::MatrixBase<Residual>& residual,
                double weight = 1.0) {
    // Eigen divides by the number of rows.
    if (residual.size() == 0) {
      return;
    }
    if constexpr ((Jacobian::Flags & Eigen::DirectAccessBit) == 0) {
      // Of an expression that is not evaluated, rankUpdate() would count a factor once, not twice.
      addDense(jacobian.eval(), residual, weight);
    } else {
      upper_.template selfadjointView<Eigen::Upper>().rankUpdate(jacobian.transpose(), weight);
      gradient_.noalias() += weight * (jacobian.transpose() * residual);
      squared_misfit_ += weight * residual.squaredNorm();
    }
  }

  /// A sum over some of the coordinates. `places`: theirs, ascending.
  void addAt(const std::vector<Eigen::Index>& places, const InformationSum& other);
  /// The same in some of the coordinates, the others held. `places`: theirs, ascending.
  InformationSum at(const std::vector<Eigen::Index>& places) const;

  /// From here on gradient and misfit are those at coordinates that are `step` farther on, as
  /// linear residuals say.
  void moveBy(const Eigen::VectorXd& step);

  /// Takes CᵀKC off the information, what was spent on quantities beside the coordinates; they add
  /// `misfit` of their own. `crossed`: C, of which only `columns` (ascending) are not zero.
  template <typename Crossed, typename Covariance>
  void takeOff(const Crossed& crossed,
               const std::vector<Eigen::Index>& columns,
               const Covariance& covariance,
               double misfit) {
    Eigen::MatrixXd own(crossed.rows(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      own.col(static_cast<Eigen::Index>(k)) = crossed.col(columns[k]);
    }
    const Eigen::MatrixXd spent = covariance * own;
    for (std::size_t b = 0; b < columns.size(); ++b) {
      for (std::size_t a = 0; a <= b; ++a) {
        upper_(columns[a], columns[b]) -=
            own.col(static_cast<Eigen::Index>(a)).dot(spent.col(static_cast<Eigen::Index>(b)));
      }
    }
    squared_misfit_ += misfit;
  }

  /// Σ JᵀS⁻¹J, F×F.
  Eigen::MatrixXd information() const;
  double information(Eigen::Index a, Eigen::Index b) const {
    return upper_(std::min(a, b), std::max(a, b));
  }
  /// Some rows of it. `rows`: ascending.
  Eigen::MatrixXd information(const std::vector<Eigen::Index>& rows) const;
  /// Σ JᵀS⁻¹r, half the derivative of Σ rᵀS⁻¹r.
  const Eigen::VectorXd& gradient() const { return gradient_; }
  /// Σ rᵀS⁻¹r.
  double squaredMisfit() const { return squared_misfit_; }

 private:
  Eigen::MatrixXd upper_;  ///< of the information: the lower triangle is not summed up
  Eigen::VectorXd gradient_;
  double squared_misfit_ = 0.0;
};

}  // namespace sac
