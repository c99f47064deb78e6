#include "spherical_actuator_calibration/estimation/sequential_update.hpp"

#include <Eigen/Cholesky>

namespace sac {

SequentialUpdate::SequentialUpdate(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance)
    : mean_(Eigen::VectorXd::Zero(mean.size() + kSharedErrors)),
      covariance_(Eigen::MatrixXd::Zero(mean_.size(), mean_.size())) {
  mean_.head(size()) = mean;
  covariance_.topLeftCorner(size(), size()) = covariance;
  beginDwell();
}

void SequentialUpdate::settle() {
  if (gain_.rows() > 0) {
    covariance_.noalias() -= gain_ * gain_.transpose();
    gain_.resize(0, 3);
  }
}

Eigen::MatrixXd SequentialUpdate::covariance() const {
  const Eigen::MatrixXd covariance = covariance_.topLeftCorner(size(), size());
  if (gain_.rows() == 0) {
    return covariance;
  }
  return covariance - gain_.topRows(size()) * gain_.topRows(size()).transpose();
}

void SequentialUpdate::beginDwell() {
  settle();
  mean_.tail<kSharedErrors>().setZero();
  covariance_.rightCols<kSharedErrors>().setZero();
  covariance_.bottomRows<kSharedErrors>().setZero();
  covariance_.bottomRightCorner<kSharedErrors, kSharedErrors>().setIdentity();
}

/// With H = (J, −G), S = 1 + H P Hᵀ = LLᵀ and K = P Hᵀ L⁻ᵀ the mean goes by −K L⁻¹ (residual +
/// H mean), the covariance P by −K Kᵀ.
void SequentialUpdate::observe(const WhitenedObservation& observation,
                               const SharedLoading& loading) {
  settle();
  Rows spread = -covariance_.rightCols<kSharedErrors>() * loading.transpose();
  spread += observation.timesTransposed(covariance_);
  Eigen::Matrix3d S = observation.times(spread) - loading * spread.bottomRows<kSharedErrors>();
  S.diagonal().array() += 1.0;
  Eigen::Vector3d residual = observation.residual - loading * mean_.tail<kSharedErrors>();
  for (std::size_t k = 0; k < observation.columns.size(); ++k) {
    residual +=
        observation.jacobian.col(static_cast<Eigen::Index>(k)) * mean_[observation.columns[k]];
  }
  const Eigen::LLT<Eigen::Matrix3d> factor(S);
  const Eigen::Vector3d surprise = factor.solve(residual);
  chi_square_ += residual.dot(surprise);
  mean_.noalias() -= spread * surprise;
  gain_ = factor.matrixL().solve(spread.transpose()).transpose();
}

}  // namespace sac
