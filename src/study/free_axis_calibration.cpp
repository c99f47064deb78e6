#include "spherical_actuator_calibration/study/free_axis_calibration.hpp"

#include <Eigen/QR>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

using Row = Eigen::Matrix<double, 3, 12>;

/// Exponential of the cross-product matrix of an axis of any length.
Eigen::Matrix3d turn(const FreeAxes& joints, const Eigen::Vector3d& q, Eigen::Index k) {
  return rotationExp((q[k] + joints.offsets[k]) * joints.axes.col(k));
}

/// ∂ξ of the orientation by (δω₁, δq₁, δω₂, δq₂, δω₃, δq₃), as in doc/method.md, Joint (12–14).
Row derivative(const FreeAxes& joints, const Eigen::Vector3d& q) {
  Row row;
  Eigen::Matrix3d before = Eigen::Matrix3d::Identity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double angle = q[k] + joints.offsets[k];
    row.middleCols<3>(4 * k) = before * angle * leftJacobian(angle * joints.axes.col(k));
    row.col(4 * k + 3) = before * joints.axes.col(k);
    before = before * turn(joints, q, k);
  }
  return row;
}

class Iteration {
 public:
  Iteration(const std::vector<Sample>& samples, JacobianUse use) : samples_(samples), use_(use) {}

  FreeAxisPath run(const FreeAxes& start, int iterations) {
    FreeAxisPath path;
    FreeAxes joints = start;
    for (int n = 0; n <= iterations; ++n) {
      const Eigen::VectorXd y = residuals(joints);
      path.joints.push_back(joints);
      path.errors.push_back(meanNorm(y));
      if (n == 0 || use_ == JacobianUse::kEveryIteration) {
        solver_.compute(jacobian(joints));
      }
      const Eigen::VectorXd step = solver_.solve(y);
      for (Eigen::Index k = 0; k < 3; ++k) {
        joints.axes.col(k) += step.segment<3>(4 * k);
        joints.offsets[k] += step[4 * k + 3];
      }
    }
    return path;
  }

 private:
  Eigen::VectorXd residuals(const FreeAxes& joints) const {
    Eigen::VectorXd y(3 * static_cast<Eigen::Index>(samples_.size()));
    Eigen::Index row = 0;
    for (const Sample& sample : samples_) {
      y.segment<3>(row) = rotationLog(sample.R_stator_rotor *
                                      rotorOrientation(joints, sample.joint_position).transpose());
      row += 3;
    }
    return y;
  }

  Eigen::MatrixXd jacobian(const FreeAxes& joints) const {
    Eigen::MatrixXd J(3 * static_cast<Eigen::Index>(samples_.size()), 12);
    Eigen::Index row = 0;
    for (const Sample& sample : samples_) {
      J.middleRows<3>(row) = derivative(joints, sample.joint_position);
      row += 3;
    }
    return J;
  }

  static double meanNorm(const Eigen::VectorXd& y) {
    double sum = 0.0;
    for (Eigen::Index row = 0; row < y.size(); row += 3) {
      sum += y.segment<3>(row).norm();
    }
    return sum / (static_cast<double>(y.size()) / 3.0);
  }

  const std::vector<Sample>& samples_;
  JacobianUse use_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver_;
};

}  // namespace

Eigen::Matrix3d rotorOrientation(const FreeAxes& joints, const Eigen::Vector3d& q) {
  return turn(joints, q, 0) * turn(joints, q, 1) * turn(joints, q, 2);
}

FreeAxisPath calibrateFreeAxes(const std::vector<Sample>& samples,
                               const FreeAxes& start,
                               JacobianUse use,
                               int iterations) {
  std::vector<Sample> oriented;
  for (const Sample& sample : samples) {
    if (sample.has_orientation) {
      oriented.push_back(sample);
    }
  }
  return Iteration(oriented, use).run(start, iterations);
}

}  // namespace sac
