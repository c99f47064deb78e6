#include "cube_rotations.hpp"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {

std::vector<Eigen::Matrix3d> cubeRotations() {
  std::vector<Eigen::Matrix3d> rotations = {Eigen::Matrix3d::Identity()};
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (const auto& order : kOrders) {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row) {
        rotation(row, order[static_cast<std::size_t>(row)]) = (signs >> row) % 2 == 0 ? 1.0 : -1.0;
      }
      if (rotation.determinant() > 0.0 && !rotation.isIdentity()) {
        rotations.push_back(rotation);
      }
    }
  }
  return rotations;
}

std::string rotationInWords(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  Eigen::Vector3d axis = turn.axis();
  std::string text = format("%.4g deg about ", turn.angle() / kOneDegree);
  constexpr double kOnAxis = 1e-6;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) > 1.0 - kOnAxis) {
      return text + (axis[k] < 0.0 ? "-" : "") + "xyz"[k];
    }
  }
  const double largest = axis.cwiseAbs().maxCoeff();
  if (((axis / largest).array() - (axis / largest).array().round()).abs().maxCoeff() < kOnAxis) {
    axis /= largest;
  }
  return text + format("(%.3g, %.3g, %.3g)", axis.x(), axis.y(), axis.z());
}

}  // namespace sac
