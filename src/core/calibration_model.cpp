#include "spherical_actuator_calibration/core/calibration_model.hpp"

#include <cmath>
#include <utility>

#include <boost/container/small_vector.hpp>

#include "spherical_actuator_calibration/core/rotations.hpp"
#include "spherical_actuator_calibration/core/spherical_joint.hpp"
#include "spherical_actuator_calibration/core/torque_model.hpp"

namespace spherical_actuator_calibration {
namespace {

using RowBlock = Eigen::Map<Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>,
                            Eigen::Unaligned,
                            Eigen::OuterStride<>>;

RowBlock mapBlock(const JacobianBlock& block, Eigen::Index columns) {
  return {block.data, 3, columns, Eigen::OuterStride<>(block.stride)};
}

/// Joint axes and offsets at the coordinates, with ∂axis/∂(u, v) of each.
struct JointPoint {
  JointGeometry geometry;
  std::array<Eigen::Matrix<double, 3, 2>, kJoints> d_axis;
};

JointPoint jointPoint(const ParameterSpace& space, const double* joints) {
  JointPoint point;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const double* at = joints + space.joint(k);
    const auto column = static_cast<Eigen::Index>(k);
    Eigen::Vector3d axis;
    space.jointChart(k).evaluate(at[1], at[2], axis, point.d_axis[k]);
    point.geometry.axes.col(column) = axis;
    point.geometry.offsets[column] = space.nominal().joints[k].offset + at[0];
  }
  return point;
}

/// left · ∂ξ/∂(offset, u, v of each joint) into `block`.
void writeJointJacobian(const JointPoint& point,
                        const JointLinearization& linear,
                        const Eigen::Matrix3d& left,
                        const JacobianBlock& block) {
  RowBlock jacobian = mapBlock(block, ParameterSpace::kPerJoint * kJoints);
  for (std::size_t k = 0; k < kJoints; ++k) {
    const auto first = ParameterSpace::kPerJoint * static_cast<Eigen::Index>(k);
    jacobian.col(first) = left * linear.d_offset.col(static_cast<Eigen::Index>(k));
    jacobian.middleCols<2>(first + 1) = left * (linear.d_axis[k] * point.d_axis[k]);
  }
}

/// One excited coil while a torque residual is summed up.
struct CoilTerm {
  Eigen::Vector3d coil_stator;
  Eigen::Vector3d coil_rotor;
  Eigen::Matrix<double, 3, 2> d_axis;  ///< ∂s⁰/∂(u, v)
  Eigen::Matrix3d d_coil;              ///< ∂T/∂s
  double weight = 0.0;                 ///< current times coil gain [A]
};

using CoilTerms = boost::container::small_vector<CoilTerm, 8>;

CoilTerms coilTerms(const ParameterSpace& space,
                    const std::vector<Excitation>& excitations,
                    const double* const* coils,
                    const Eigen::Matrix3d& R_rotor_stator) {
  CoilTerms terms(excitations.size());
  for (std::size_t e = 0; e < excitations.size(); ++e) {
    const std::size_t coil = excitations[e].coil;
    CoilTerm& term = terms[e];
    space.coilChart(coil).evaluate(coils[e][0], coils[e][1], term.coil_stator, term.d_axis);
    term.coil_rotor = R_rotor_stator * term.coil_stator;
    term.d_coil.setZero();
    term.weight = excitations[e].current * space.nominal().coils[coil].gain;
  }
  return terms;
}

/// Model torque of all pole–coil pairs [N·m].
Eigen::Vector3d plainTorque(const ParameterSpace& space,
                            const TorqueCurve& curve,
                            const CalibrationModel::TorqueBlocks& blocks,
                            const CoilTerms& terms) {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < space.poles(); ++i) {
    const PoleAxis& pole = space.nominal().poles[i];
    const Eigen::Vector3d pole_rotor =
        space.poleChart(i).axis(blocks.poles[2 * i], blocks.poles[2 * i + 1]);
    for (const CoilTerm& term : terms) {
      if (interacts(curve, pole_rotor, term.coil_rotor)) {
        torque += term.weight * pole.polarity * pole.gain *
                  pairTorque(curve, pole_rotor, term.coil_rotor);
      }
    }
  }
  return torque;
}

/// The same, with the pole block of the residual's Jacobian and each term's ∂T/∂s.
Eigen::Vector3d linearizeTorque(const ParameterSpace& space,
                                const TorqueCurve& curve,
                                const CalibrationModel::TorqueBlocks& blocks,
                                CoilTerms& terms) {
  const bool wants_poles = blocks.d_poles.data != nullptr;
  RowBlock d_poles =
      mapBlock(blocks.d_poles, wants_poles ? static_cast<Eigen::Index>(2 * space.poles()) : 0);
  d_poles.setZero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < space.poles(); ++i) {
    const PoleAxis& pole = space.nominal().poles[i];
    Eigen::Vector3d pole_rotor;
    Eigen::Matrix<double, 3, 2> d_axis;
    space.poleChart(i).evaluate(blocks.poles[2 * i], blocks.poles[2 * i + 1], pole_rotor, d_axis);
    for (CoilTerm& term : terms) {
      if (!interacts(curve, pole_rotor, term.coil_rotor)) {
        continue;
      }
      const double weight = term.weight * pole.polarity * pole.gain;
      const PairTorque pair = linearizePairTorque(curve, pole_rotor, term.coil_rotor);
      torque += weight * pair.torque;
      term.d_coil += weight * pair.d_coil;
      if (wants_poles) {
        d_poles.middleCols<2>(static_cast<Eigen::Index>(2 * i)) -= weight * pair.d_pole * d_axis;
      }
    }
  }
  return torque;
}

}  // namespace

std::vector<Excitation> excitedCoils(const Sample& sample, double threshold) {
  std::vector<Excitation> excitations;
  for (Eigen::Index j = 0; j < sample.current.size(); ++j) {
    if (std::abs(sample.current[j]) >= threshold) {
      excitations.push_back({static_cast<std::size_t>(j), sample.current[j]});
    }
  }
  return excitations;
}

CalibrationModel::CalibrationModel(ParameterSpace space) : space_(std::move(space)) {
  if (space_.nominal().hasTorqueModel()) {
    curve_.emplace(*space_.nominal().torque_curve);
  }
}

Eigen::Vector3d CalibrationModel::orientationResidual(const Sample& sample,
                                                      const double* joints,
                                                      JacobianBlock d_joints) const {
  const JointPoint point = jointPoint(space_, joints);
  if (d_joints.data == nullptr) {
    return rotationLog(sample.R_stator_rotor *
                       rotorOrientation(point.geometry, sample.joint_position).transpose());
  }
  const JointLinearization linear =
      linearizeRotorOrientation(point.geometry, sample.joint_position);
  Eigen::Vector3d y = rotationLog(sample.R_stator_rotor * linear.R_stator_rotor.transpose());
  // R → e^{ξ̂}R turns e^{ŷ} into e^{ŷ}e^{−ξ̂}, and J_r(y) = J_l(−y).
  writeJointJacobian(point, linear, -leftJacobianInverse(-y), d_joints);
  return y;
}

Eigen::Vector3d CalibrationModel::torqueResidual(const Sample& sample,
                                                 const std::vector<Excitation>& excitations,
                                                 const TorqueBlocks& blocks) const {
  const bool wants_joints = blocks.d_joints.data != nullptr;
  const JointPoint point = jointPoint(space_, blocks.joints);
  JointLinearization linear;
  if (wants_joints) {
    linear = linearizeRotorOrientation(point.geometry, sample.joint_position);
  } else {
    linear.R_stator_rotor = rotorOrientation(point.geometry, sample.joint_position);
  }
  const Eigen::Matrix3d R_rotor_stator = linear.R_stator_rotor.transpose();
  CoilTerms terms = coilTerms(space_, excitations, blocks.coils, R_rotor_stator);
  const bool wants_jacobian =
      wants_joints || blocks.d_poles.data != nullptr || blocks.d_coils != nullptr;
  const Eigen::Vector3d torque = wants_jacobian ? linearizeTorque(space_, *curve_, blocks, terms)
                                                : plainTorque(space_, *curve_, blocks, terms);
  // s = Rᵀ s⁰, so ∂s/∂ξ = Rᵀ ŝ⁰ and ∂s/∂s⁰ = Rᵀ; the residual carries the minus sign.
  if (wants_joints) {
    Eigen::Matrix3d d_rotation = Eigen::Matrix3d::Zero();
    for (const CoilTerm& term : terms) {
      d_rotation -= term.d_coil * R_rotor_stator * skew(term.coil_stator);
    }
    writeJointJacobian(point, linear, d_rotation, blocks.d_joints);
  }
  for (std::size_t e = 0; blocks.d_coils != nullptr && e < terms.size(); ++e) {
    if (blocks.d_coils[e].data != nullptr) {
      mapBlock(blocks.d_coils[e], ParameterSpace::kPerAxis) =
          -terms[e].d_coil * R_rotor_stator * terms[e].d_axis;
    }
  }
  return sample.torque - torque;
}

}  // namespace spherical_actuator_calibration
