#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// D of one observation: its derivatives by the errors of the pose, which come last.
inline Eigen::Matrix3d errorColumns(const WhitenedObservation& observation, Eigen::Index count) {
  Eigen::Matrix3d columns = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < observation.columns.size(); ++k) {
    if (observation.columns[k] >= count) {
      columns.col(observation.columns[k] - count) =
          observation.jacobian.col(static_cast<Eigen::Index>(k));
    }
  }
  return columns;
}

/// What an elimination L of the pose's errors makes of G.
struct Eliminated {
  Eigen::Matrix<double, Eigen::Dynamic, 3> G_L;  ///< G Lᵀ
  Eigen::Matrix3d L_G_L;                         ///< L G Lᵀ
};

/// tr((J − D L) G (J − D L)ᵀ) of one observation.
inline double ownForm(const WhitenedObservation& observation,
                      const Eigen::MatrixXd& G,
                      const Eliminated& by) {
  const std::vector<Eigen::Index>& columns = observation.columns;
  double plain = 0.0;
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < columns.size() && columns[k] < G.rows(); ++k) {
    const Eigen::Vector3d of_k = observation.jacobian.col(static_cast<Eigen::Index>(k));
    double beside = 0.5 * G(columns[k], columns[k]) * of_k.squaredNorm();
    for (std::size_t l = 0; l < k; ++l) {
      beside += G(columns[l], columns[k]) *
                of_k.dot(observation.jacobian.col(static_cast<Eigen::Index>(l)));
    }
    plain += 2.0 * beside;
    across.noalias() += of_k * by.G_L.row(columns[k]);
  }
  const Eigen::Matrix3d D = errorColumns(observation, G.rows());
  return plain + D.cwiseProduct(D * by.L_G_L - 2.0 * across).sum();
}

/// tr((J_a − D_a L) G (J_b − D_b L)ᵀ) of all pairs of observations at one pose, for any L. What L
/// changes are products of 3×3 blocks: G itself is multiplied once.
class PairForm {
 public:
  /// Keeps references to both.
  PairForm(std::vector<const WhitenedObservation*> observations, const Eigen::MatrixXd& G)
      : observations_(std::move(observations)), G_(G) {
    const auto count = static_cast<Eigen::Index>(observations_.size());
    plain_.resize(count, count);
    Eigen::Matrix<double, Eigen::Dynamic, 3> H(G.rows(), 3);
    for (Eigen::Index b = 0; b < count; ++b) {
      const WhitenedObservation& of_b = *observations_[static_cast<std::size_t>(b)];
      H.setZero();
      for (std::size_t k = 0; k < of_b.columns.size() && of_b.columns[k] < G.rows(); ++k) {
        H.noalias() +=
            G.col(of_b.columns[k]) * of_b.jacobian.col(static_cast<Eigen::Index>(k)).transpose();
      }
      for (Eigen::Index a = 0; a <= b; ++a) {
        plain_(a, b) = traceOf(*observations_[static_cast<std::size_t>(a)], H);
        plain_(b, a) = plain_(a, b);
      }
      errors_.push_back(errorColumns(of_b, G.rows()));
    }
  }

  Eigen::MatrixXd eliminated(const Eliminated& by) const {
    std::vector<Eigen::Matrix3d> across;
    for (const WhitenedObservation* const observation : observations_) {
      Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
      for (std::size_t k = 0;
           k < observation->columns.size() && observation->columns[k] < G_.rows();
           ++k) {
        product += observation->jacobian.col(static_cast<Eigen::Index>(k)) *
                   by.G_L.row(observation->columns[k]);
      }
      across.push_back(product);
    }
    Eigen::MatrixXd form = plain_;
    for (std::size_t b = 0; b < errors_.size(); ++b) {
      const Eigen::Matrix3d of_b = errors_[b] * by.L_G_L - across[b];
      for (std::size_t a = 0; a <= b; ++a) {
        const double change =
            errors_[a].cwiseProduct(of_b).sum() - across[a].cwiseProduct(errors_[b]).sum();
        const auto row = static_cast<Eigen::Index>(a);
        const auto column = static_cast<Eigen::Index>(b);
        form(row, column) += change;
        form(column, row) = form(row, column);
      }
    }
    return form;
  }

 private:
  /// tr(J_a G J_bᵀ), from H = G J_bᵀ.
  double traceOf(const WhitenedObservation& a,
                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& H) const {
    double trace = 0.0;
    for (std::size_t k = 0; k < a.columns.size() && a.columns[k] < G_.rows(); ++k) {
      trace += a.jacobian.col(static_cast<Eigen::Index>(k)).dot(H.row(a.columns[k]));
    }
    return trace;
  }

  std::vector<const WhitenedObservation*> observations_;
  const Eigen::MatrixXd& G_;
  Eigen::MatrixXd plain_;
  std::vector<Eigen::Matrix3d> errors_;  ///< D of each
};

}  // namespace sac
