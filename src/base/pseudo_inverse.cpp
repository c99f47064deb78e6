#include "spherical_actuator_calibration/base/pseudo_inverse.hpp"

#include <Eigen/QR>

namespace sac {

Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace sac
