#include "spherical_actuator_calibration/assessment/reported_covariance.hpp"

namespace sac {

Eigen::MatrixXd reportedJacobian(const ParameterSpace& space, const Eigen::VectorXd& x) {
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd jacobian(space.size(), space.size());
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(space.size(), p);
    jacobian.col(p) =
        (space.reportedValues(x + step) - space.reportedValues(x - step)) / (2.0 * kStep);
  }
  return jacobian;
}

Eigen::MatrixXd reportedCovariance(const CalibrationSession& session) {
  const ParameterBelief& belief = session.state().belief;
  const Eigen::MatrixXd jacobian = reportedJacobian(session.model().space(), belief.x);
  return jacobian * belief.covariance * jacobian.transpose();
}

}  // namespace sac
