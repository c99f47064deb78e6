#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

TEST(SphericalJoint, NominalJointIsTheProductOfThreeElementaryRotations) {
  const Eigen::Vector3d q(0.3, -0.2, 2.0);
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(q[0], Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(q[1], Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(q[2], Eigen::Vector3d::UnitZ()))
                                       .toRotationMatrix();
  const JointGeometry joints = jointGeometry(scenarios::paperNominal().joints);
  EXPECT_LT((rotorOrientation(joints, q) - expected).norm(), 1e-15);
}

TEST(SphericalJoint, OffsetsAddToTheReadings) {
  JointGeometry joints = jointGeometry(scenarios::paperTruth().joints);
  const Eigen::Vector3d q(0.3, -0.2, 2.0);
  const Eigen::Matrix3d R = rotorOrientation(joints, q);
  const Eigen::Vector3d moved = q + joints.offsets;
  joints.offsets.setZero();
  EXPECT_LT((rotorOrientation(joints, moved) - R).norm(), 1e-15);
}

TEST(SphericalJoint, LinearizationIsTheDerivativeInAxesAndOffsets) {
  const JointGeometry joints = jointGeometry(scenarios::paperTruth().joints);
  const Eigen::Vector3d q(0.5, -0.4, -2.8);
  const JointLinearization linear = linearizeRotorOrientation(joints, q);
  EXPECT_EQ(linear.R_stator_rotor, rotorOrientation(joints, q));
  const auto left_error = [&](const Eigen::VectorXd& delta) -> Eigen::VectorXd {
    JointGeometry moved = joints;
    moved.offsets += delta.head<3>();
    moved.axes += Eigen::Map<const Eigen::Matrix3d>(delta.data() + 3);
    return rotationLog(rotorOrientation(moved, q) * linear.R_stator_rotor.transpose());
  };
  const Eigen::MatrixXd numeric = numericJacobian(left_error, Eigen::VectorXd::Zero(12));
  EXPECT_LT((linear.d_offset - numeric.leftCols<3>()).cwiseAbs().maxCoeff(), 1e-9);
  for (std::size_t k = 0; k < kJoints; ++k) {
    const auto first = static_cast<Eigen::Index>(3 + 3 * k);
    EXPECT_LT((linear.d_axis[k] - numeric.middleCols<3>(first)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(InverseKinematics, AnglesOfAFreeRotorGiveItsOrientationEverywhere) {
  const JointGeometry joints = jointGeometry(freeRotorJoints());
  const double lock = 0.5 * kPi;
  for (const double q2 : {0.0, 0.4, lock - 1e-4, lock - 1e-12, lock, -lock, -lock + 1e-9}) {
    for (const double q1 : {-3.1, -0.5, 0.0, 2.0, kPi}) {
      for (const double q3 : {-kPi, -1.0, 0.0, 3.0}) {
        const Eigen::Matrix3d R = rotorOrientation(joints, {q1, q2, q3});
        const Eigen::Vector3d q = freeRotorAngles(R);
        EXPECT_LT((rotorOrientation(joints, q) - R).norm(), 1e-14) << q1 << " " << q2 << " " << q3;
      }
    }
  }
  const Eigen::Vector3d q(0.3, -0.2, 2.0);
  EXPECT_LT((freeRotorAngles(rotorOrientation(joints, q)) - q).norm(), 1e-15);
}

TEST(FreeRotor, AnglesOfARotorThatTurnsOnDoNotJump) {
  const JointGeometry joints = jointGeometry(freeRotorJoints());
  Eigen::Vector3d followed(0.2, -0.3, 0.0);
  for (double q3 = 0.0; q3 < 20.0; q3 += 0.1) {
    const Eigen::Matrix3d R = rotorOrientation(joints, {0.2, -0.3, q3});
    followed = nearestTurns(freeRotorAngles(R), followed);
    EXPECT_NEAR(followed[2], q3, 1e-12);
  }
  EXPECT_EQ(nearestTurns({3.0, 0.1, -3.0}, {-3.0, 0.5, -2.9}), Eigen::Vector3d(3.0, 0.1, -3.0));
}

}  // namespace
}  // namespace sac
