#include "spherical_actuator_calibration/estimation/joint_point.hpp"

#include <cmath>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {

JointPoint::JointPoint(const ParameterSpace& space, const Eigen::VectorXd& x) {
  const Eigen::Vector3d nominal = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < kJoints; ++k) {
    const bool is_real = k < space.joints();
    const double* const at = is_real ? x.data() + space.joint(k) : nominal.data();
    const AxisChart chart =
        is_real ? space.jointChart(k) : AxisChart::aroundAxis(space.nominal().joints[k].axis);
    Joint& joint = joints_[k];
    chart.evaluate(at[1], at[2], joint.axis, joint.d_axis);
    joint.along = joint.axis * joint.axis.transpose();
    joint.across = Eigen::Matrix3d::Identity() - joint.along;
    joint.crossed = skew(joint.axis);
    joint.d_crossed = joint.crossed * joint.d_axis;
    joint.offset = space.nominal().joints[k].offset + at[0];
  }
}

Eigen::Matrix3d JointPoint::orientation(const Eigen::Vector3d& q) const {
  const auto turn = [&](std::size_t k) {
    const double angle = q[static_cast<Eigen::Index>(k)] + joints_[k].offset;
    return joints_[k].turn(std::sin(angle), std::cos(angle));
  };
  return turn(0) * turn(1) * turn(2);
}

JointPoint::Linearized JointPoint::linearized(const Eigen::Vector3d& q) const {
  Linearized out;
  Eigen::Matrix3d& A = out.R_stator_rotor;  // of the joints before
  for (std::size_t k = 0; k < kJoints; ++k) {
    const Joint& joint = joints_[k];
    const double angle = q[static_cast<Eigen::Index>(k)] + joint.offset;
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    // A unit axis moves across itself: q J_l(ωq) δω = sin q δω + (1 − cos q) ω̂ δω.
    Eigen::Matrix3d own;
    own.col(0) = joint.axis;
    own.rightCols<2>() = sine * joint.d_axis + (1.0 - cosine) * joint.d_crossed;
    const Eigen::Matrix3d turn = joint.turn(sine, cosine);
    const auto first = static_cast<Eigen::Index>(k) * ParameterSpace::kPerJoint;
    if (k == 0) {
      out.d_coordinates.middleCols<3>(first) = own;
      A = turn;
    } else {
      out.d_coordinates.middleCols<3>(first).noalias() = A * own;
      A = (A * turn).eval();
    }
  }
  return out;
}

}  // namespace sac
