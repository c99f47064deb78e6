#include "spherical_actuator_calibration/estimation/sequential_update.hpp"

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {
namespace {

/// Columns of gains that the covariance waits for: those of many observations at once take less
/// time where there are many coordinates, and each observation takes more.
Eigen::Index mostColumns(Eigen::Index coordinates) {
  constexpr Eigen::Index kMany = 256;
  constexpr Eigen::Index kObservations = 16;
  return coordinates > kMany ? 3 * kObservations : 3;
}

}  // namespace

SequentialUpdate::SequentialUpdate(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance)
    : mean_(Eigen::VectorXd::Zero(mean.size() + kSharedErrors)),
      covariance_(Eigen::MatrixXd::Zero(mean_.size(), mean_.size())),
      gains_(mean_.size(), mostColumns(mean.size())) {
  mean_.head(size()) = mean;
  covariance_.topLeftCorner(size(), size()) = covariance;
  beginDwell();
}

void SequentialUpdate::settle() {
  if (gain_columns_ > 0) {
    covariance_.noalias() -= gains() * gains().transpose();
    gain_columns_ = 0;
  }
}

Eigen::MatrixXd SequentialUpdate::covariance() const {
  Eigen::MatrixXd covariance = covariance_.topLeftCorner(size(), size());
  covariance.noalias() -= gains().topRows(size()) * gains().topRows(size()).transpose();
  return covariance;
}

void SequentialUpdate::beginDwell() {
  gains_.bottomRows<kSharedErrors>().setZero();
  mean_.tail<kSharedErrors>().setZero();
  covariance_.rightCols<kSharedErrors>().setZero();
  covariance_.bottomRows<kSharedErrors>().setZero();
  covariance_.bottomRightCorner<kSharedErrors, kSharedErrors>().setIdentity();
}

/// With H = (J, −G), S = 1 + H P Hᵀ = LLᵀ and K = P Hᵀ L⁻ᵀ the mean goes by −K L⁻¹ (residual +
/// H mean), the covariance P by −K Kᵀ.
void SequentialUpdate::observe(const WhitenedObservation& observation,
                               const SharedLoading& loading) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  if (gain_columns_ == gains_.cols()) {
    settle();
  }
  Rows spread = -covariance_.rightCols<kSharedErrors>() * loading.transpose();
  spread += observation.timesTransposed(covariance_);
  Rows seen = -gains().bottomRows<kSharedErrors>().transpose() * loading.transpose();
  Eigen::Vector3d residual = observation.residual - loading * mean_.tail<kSharedErrors>();
  for (std::size_t k = 0; k < observation.columns.size(); ++k) {
    const auto column = observation.jacobian.col(static_cast<Eigen::Index>(k));
    seen += gains().row(observation.columns[k]).transpose() * column.transpose();
    residual += column * mean_[observation.columns[k]];
  }
  spread.noalias() -= gains() * seen;
  Eigen::Matrix3d S = observation.times(spread) - loading * spread.bottomRows<kSharedErrors>();
  S.diagonal().array() += 1.0;
  const Cholesky3 factor(S);
  const Eigen::Vector3d surprise = factor.solve(residual);
  chi_square_ += residual.dot(surprise);
  mean_.noalias() -= spread * surprise;
  gains_.middleCols<3>(gain_columns_) = factor.half(spread.transpose()).transpose();
  gain_columns_ += 3;
}

}  // namespace sac
