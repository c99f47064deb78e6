#include "linear_coils.hpp"

#include <cstddef>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

Eigen::VectorXd variancesBesideCommon(const ParameterSpace& space,
                                      const Eigen::MatrixXd& covariance) {
  constexpr double kRounding = 1e-12;  // of a variance
  std::vector<Eigen::Index> common;
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    const bool is_magnetic = p >= space.joint(space.joints()) && p < space.effect();
    if (!is_magnetic && covariance(p, p) > 0.0) {
      common.push_back(p);
    }
  }
  Eigen::MatrixXd of_common = covariance(common, common);
  of_common.diagonal() *= 1.0 + kRounding;
  // Per coordinate: the part of its variance that is due to what it has in common.
  Eigen::VectorXd due = Eigen::VectorXd::Zero(space.size());
  if (!common.empty()) {
    const Eigen::MatrixXd shared = covariance(common, Eigen::all);
    due = shared.cwiseProduct(solveSemidefinite(of_common, shared)).colwise().sum();
  }
  return covariance.diagonal() - due;
}

std::vector<bool> linearCoils(const ParameterSpace& space,
                              const ParameterBelief& belief,
                              const std::vector<bool>& identified) {
  const Eigen::VectorXd variances = variancesBesideCommon(space, belief.covariance);
  std::vector<bool> linear(space.coils());
  for (std::size_t j = 0; j < linear.size(); ++j) {
    const Eigen::Index coil = space.coil(j);
    const auto first = static_cast<std::size_t>(coil);
    linear[j] = identified[first] && identified[first + 1] &&
                variances.segment<2>(coil).sum() < kLinearRange * kLinearRange;
  }
  return linear;
}

}  // namespace sac
