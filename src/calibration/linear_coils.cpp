#include "linear_coils.hpp"

#include <cstddef>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

std::vector<bool> linearCoils(const ParameterSpace& space,
                              const ParameterBelief& belief,
                              const std::vector<bool>& identified) {
  constexpr double kRounding = 1e-12;  // of a variance
  std::vector<Eigen::Index> common;
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    const bool is_magnetic = p >= space.joint(space.joints()) && p < space.effect();
    if (!is_magnetic && belief.covariance(p, p) > 0.0) {
      common.push_back(p);
    }
  }
  Eigen::MatrixXd of_common = belief.covariance(common, common);
  of_common.diagonal() *= 1.0 + kRounding;
  // Per coordinate: the part of its variance that is due to what it has in common.
  Eigen::VectorXd due = Eigen::VectorXd::Zero(space.size());
  if (!common.empty()) {
    const Eigen::MatrixXd shared = belief.covariance(common, Eigen::all);
    due = shared.cwiseProduct(solveSemidefinite(of_common, shared)).colwise().sum();
  }
  std::vector<bool> linear(space.coils());
  for (std::size_t j = 0; j < linear.size(); ++j) {
    const Eigen::Index coil = space.coil(j);
    const auto first = static_cast<std::size_t>(coil);
    const double variance =
        belief.covariance.block<2, 2>(coil, coil).trace() - due.segment<2>(coil).sum();
    linear[j] =
        identified[first] && identified[first + 1] && variance < kLinearRange * kLinearRange;
  }
  return linear;
}

}  // namespace sac
