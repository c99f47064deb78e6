#include "spherical_actuator_calibration/estimation/open_directions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/pseudo_inverse.hpp"

namespace sac {
namespace {

/// ∂ξ/∂(coordinates of the joints) at joint angles q, 3×9.
Eigen::Matrix<double, 3, 9> rotationJacobian(const ParameterSpace& space,
                                             const JointGeometry& joints,
                                             const Eigen::VectorXd& x,
                                             const Eigen::Vector3d& q) {
  const JointLinearization linear = linearizeRotorOrientation(joints, q);
  Eigen::Matrix<double, 3, 9> J;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const Eigen::Index at = space.joint(k);
    J.col(at) = linear.d_offset.col(static_cast<Eigen::Index>(k));
    J.middleCols<2>(at + 1) = linear.d_axis[k] * space.jointChart(k).jacobian(x[at + 1], x[at + 2]);
  }
  return J;
}

/// Change of the joints' coordinates that turns R(q) at every q: 9×3. Any poses in general position
/// tell it.
Eigen::Matrix<double, 9, 3> jointRotations(const ParameterSpace& space, const Eigen::VectorXd& x) {
  constexpr double kAngle = 0.7;  // [rad]
  constexpr Eigen::Index kCorners = 8;
  const JointGeometry joints = jointGeometry(space.actuatorAt(x));
  Eigen::MatrixXd jacobian(3 * kCorners, 9);
  Eigen::MatrixXd rotation(3 * kCorners, 3);
  for (Eigen::Index corner = 0; corner < kCorners; ++corner) {
    const auto angle = [corner](Eigen::Index bit) {
      return (corner >> bit) % 2 == 0 ? kAngle : -kAngle;
    };
    const Eigen::Vector3d q(angle(0), angle(1), angle(2));
    jacobian.middleRows<3>(3 * corner) = rotationJacobian(space, joints, x, q);
    rotation.middleRows<3>(3 * corner).setIdentity();
  }
  return pseudoInverse(jacobian) * rotation;
}

std::string combinationName(const ParameterSpace& space, const Eigen::VectorXd& direction) {
  constexpr std::size_t kNamed = 3;
  constexpr double kParticipation = 0.1;
  const auto taking_part =
      static_cast<std::size_t>((direction.array().abs() > kParticipation).count());
  std::vector<Eigen::Index> order(static_cast<std::size_t>(direction.size()));
  std::iota(order.begin(), order.end(), 0);
  std::partial_sort(
      order.begin(), order.begin() + kNamed, order.end(), [&](Eigen::Index a, Eigen::Index b) {
        return std::abs(direction[a]) > std::abs(direction[b]);
      });
  std::string name = "a combination of";
  for (std::size_t k = 0; k < std::min(kNamed, std::max<std::size_t>(taking_part, 1)); ++k) {
    name += k == 0 ? " " : ", ";
    name += space.name(order[k]);
  }
  return taking_part > kNamed ? name + " and others" : name;
}

}  // namespace

Eigen::MatrixXd statorRotations(const ParameterSpace& space, const Eigen::VectorXd& x) {
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(space.size(), 3);
  if (space.joints() > 0) {
    change.topRows<9>() = jointRotations(space, x);
  }
  for (std::size_t j = 0; j < space.coils(); ++j) {
    const Eigen::Index at = space.coil(j);
    Eigen::Vector3d axis;
    Eigen::Matrix<double, 3, 2> jacobian;
    space.coilChart(j).evaluate(x[at], x[at + 1], axis, jacobian);
    Eigen::Matrix3d turned;  // column k: e_k × axis
    for (int k = 0; k < 3; ++k) {
      turned.col(k) = Eigen::Vector3d::Unit(k).cross(axis);
    }
    change.middleRows<2>(at) = pseudoInverse(jacobian) * turned;
  }
  return change;
}

std::vector<OpenDirection> nameOpenDirections(const ParameterSpace& space,
                                              const Eigen::MatrixXd& basis,
                                              const ParameterBelief& belief) {
  constexpr double kWithin = 0.99;
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  std::vector<OpenDirection> named;
  if (basis.cols() == 0) {
    return named;
  }
  Eigen::MatrixXd rotations = statorRotations(space, belief.x);
  // Coordinates that the cycle does not estimate stay where they are.
  const Eigen::VectorXd takes_part =
      (basis.rowwise().squaredNorm().array() > 0.0).cast<double>().matrix();
  rotations = takes_part.asDiagonal() * rotations;
  const Eigen::MatrixXd within = basis * (basis.transpose() * rotations);
  const bool made_of_rotations =
      basis.cols() == rotations.cols() &&
      (within.colwise().norm().array() >= kWithin * rotations.colwise().norm().array()).all();
  if (made_of_rotations) {
    const Eigen::MatrixXd angles = pseudoInverse(rotations);
    const Eigen::MatrixXd covariance = angles * belief.covariance * angles.transpose();
    for (Eigen::Index k = 0; k < rotations.cols(); ++k) {
      named.push_back({std::string(space.joints() > 0 ? "a common rotation of joints and coils"
                                                      : "a common rotation of the coils") +
                           " about stator " + kAxes[static_cast<std::size_t>(k)],
                       std::sqrt(covariance(k, k)),
                       rotations.col(k).normalized()});
    }
    return named;
  }
  const Eigen::MatrixXd covariance = basis.transpose() * belief.covariance * basis;
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    named.push_back(
        {combinationName(space, basis.col(k)), std::sqrt(covariance(k, k)), basis.col(k)});
  }
  return named;
}

}  // namespace sac
