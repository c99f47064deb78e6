#include "residual_probe.hpp"

#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"

namespace sac {

ResidualProbe::ResidualProbe(std::vector<Eigen::Index> estimated, Eigen::Index quantities)
    : estimated_(std::move(estimated)),
      sum_(static_cast<Eigen::Index>(estimated_.size()) + quantities) {}

void ResidualProbe::add(const Eigen::MatrixXd& by_coordinates,
                        const Eigen::MatrixXd& by_quantities,
                        const Eigen::VectorXd& residual) {
  const auto count = static_cast<Eigen::Index>(estimated_.size());
  Eigen::MatrixXd jacobian(residual.size(), count + by_quantities.cols());
  jacobian.leftCols(count) = by_coordinates(Eigen::all, estimated_);
  jacobian.rightCols(by_quantities.cols()) = by_quantities;
  sum_.addDense(jacobian, residual);
}

ResidualProbe::Finding ResidualProbe::find(Eigen::Index first, Eigen::Index count) const {
  // Of the rest nothing is known that the parameters do not explain as well.
  constexpr double kLeastShare = 1e-3;
  const auto known = static_cast<Eigen::Index>(estimated_.size());
  const Eigen::MatrixXd all = sum_.information();
  const Eigen::MatrixXd both = all.block(0, known + first, known, count);
  const Eigen::MatrixXd own = all.block(known + first, known + first, count, count);
  const Eigen::MatrixXd taken_up = solveSemidefinite(all.topLeftCorner(known, known), both);
  const Eigen::MatrixXd told = own - both.transpose() * taken_up;
  const Eigen::VectorXd gradient = sum_.gradient().segment(known + first, count) -
                                   taken_up.transpose() * sum_.gradient().head(known);
  Finding finding;
  // Each in units of what is known of it where nothing else is unknown.
  const Eigen::VectorXd unit = own.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd shares = unit.asDiagonal() * told * unit.asDiagonal();
  finding.is_told = symmetricEigenvalues(shares)[0] > kLeastShare;
  if (!finding.is_told) {
    return finding;
  }
  finding.covariance = solveSemidefinite(told, Eigen::MatrixXd::Identity(count, count));
  finding.value = -finding.covariance * gradient;
  finding.bias = taken_up * finding.value;
  return finding;
}

}  // namespace sac
