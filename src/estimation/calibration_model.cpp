#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/container/small_vector.hpp>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
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

using Effect = LaboratoryEffect;

/// The modelled effects at the coordinates; those that are not modelled are as if absent.
class EffectPoint {
 public:
  EffectPoint(const ParameterSpace& space, const double* coordinates)
      : layout_(space.effects()), coordinates_(coordinates) {}

  const EffectLayout& layout() const { return layout_; }

  double value(Effect effect, Eigen::Index n) const {
    const Eigen::Index at = layout_.first(effect) + n;
    return coordinates_[at] * layout_.unit(at);
  }
  Eigen::Vector3d vector(Effect effect) const {
    return layout_.has(effect)
               ? Eigen::Vector3d(value(effect, 0), value(effect, 1), value(effect, 2))
               : Eigen::Vector3d::Zero();
  }
  double strengthScale() const {
    return layout_.has(Effect::kStrengthScale) ? 1.0 + value(Effect::kStrengthScale, 0) : 1.0;
  }
  double poleGain(std::size_t pole) const {
    return layout_.has(Effect::kPoleGains)
               ? 1.0 + value(Effect::kPoleGains, static_cast<Eigen::Index>(pole))
               : 1.0;
  }
  /// Coordinate of a coil's gain, or −1.
  Eigen::Index coilGainCoordinate(std::size_t coil) const {
    const std::size_t first = layout_.coilsWithoutGain();
    return layout_.has(Effect::kCoilGains) && coil >= first
               ? layout_.first(Effect::kCoilGains) + static_cast<Eigen::Index>(coil - first)
               : -1;
  }
  double coilGain(std::size_t coil) const {
    const Eigen::Index at = coilGainCoordinate(coil);
    return at < 0 ? 1.0 : 1.0 + coordinates_[at];
  }

  /// Joint angles of a reading: harmonics of the encoder, scale and cross-axis of the tilt sensor.
  Eigen::Vector3d corrected(const Eigen::Vector3d& q) const {
    Eigen::Vector3d angles = q;
    if (layout_.has(Effect::kEncoderHarmonics)) {
      const Eigen::Vector4d basis = harmonics(q);
      for (Eigen::Index n = 0; n < basis.size(); ++n) {
        angles[2] += basis[n] * value(Effect::kEncoderHarmonics, n);
      }
    }
    if (layout_.has(Effect::kTiltCrossAxis)) {
      for (Eigen::Index n = 0; n < 4; ++n) {
        angles[n / 2] += q[n % 2] * value(Effect::kTiltCrossAxis, n);
      }
    }
    return angles;
  }

  /// Columns of the effects that act on the readings. An error of a reading acts as an offset of
  /// that joint does: `d_offsets` has one column for each.
  void writeReadingJacobian(const Eigen::Vector3d& q,
                            const Eigen::Matrix3d& d_offsets,
                            RowBlock& jacobian) const {
    if (layout_.has(Effect::kEncoderHarmonics)) {
      const Eigen::Vector4d basis = harmonics(q);
      for (Eigen::Index n = 0; n < basis.size(); ++n) {
        const Eigen::Index at = layout_.first(Effect::kEncoderHarmonics) + n;
        jacobian.col(at) = basis[n] * layout_.unit(at) * d_offsets.col(2);
      }
    }
    if (layout_.has(Effect::kTiltCrossAxis)) {
      for (Eigen::Index n = 0; n < 4; ++n) {
        jacobian.col(layout_.first(Effect::kTiltCrossAxis) + n) = q[n % 2] * d_offsets.col(n / 2);
      }
    }
  }

 private:
  static Eigen::Vector4d harmonics(const Eigen::Vector3d& q) {
    return {std::cos(q[2]), std::sin(q[2]), std::cos(2.0 * q[2]), std::sin(2.0 * q[2])};
  }

  const EffectLayout& layout_;
  const double* coordinates_;
};

/// left · ∂ξ/∂offset of each joint.
Eigen::Matrix3d offsetColumns(const JointLinearization& linear, const Eigen::Matrix3d& left) {
  Eigen::Matrix3d columns;
  for (Eigen::Index k = 0; k < 3; ++k) {
    columns.col(k) = left * linear.d_offset.col(k);
  }
  return columns;
}

/// Direction of gravity, stator frame (doc/method.md, Laboratory).
Eigen::Vector3d gravityDirection() {
  return -Eigen::Vector3d::UnitZ();
}

/// One excited coil while a torque residual is summed up.
struct CoilTerm {
  Eigen::Vector3d coil_stator;
  Eigen::Vector3d coil_rotor;
  Eigen::Matrix<double, 3, 2> d_axis;  ///< ∂s⁰/∂(u, v)
  Eigen::Matrix3d d_coil;              ///< ∂T/∂s
  double weight = 0.0;                 ///< current times gain and common scale [A]
  double gain = 1.0;                   ///< identified part of the gain
  Eigen::Index gain_coordinate = -1;   ///< of the effects; −1: there is none
};

using CoilTerms = boost::container::small_vector<CoilTerm, 8>;

CoilTerms coilTerms(const ParameterSpace& space,
                    const std::vector<Excitation>& excitations,
                    const double* const* coils,
                    const EffectPoint& effects,
                    const Eigen::Matrix3d& R_rotor_stator) {
  CoilTerms terms(excitations.size());
  for (std::size_t e = 0; e < excitations.size(); ++e) {
    const std::size_t coil = excitations[e].coil;
    CoilTerm& term = terms[e];
    space.coilChart(coil).evaluate(coils[e][0], coils[e][1], term.coil_stator, term.d_axis);
    term.coil_rotor = R_rotor_stator * term.coil_stator;
    term.d_coil.setZero();
    term.gain = effects.coilGain(coil);
    term.gain_coordinate = effects.coilGainCoordinate(coil);
    term.weight = excitations[e].current * space.nominal().coils[coil].gain * term.gain *
                  effects.strengthScale();
  }
  return terms;
}

/// Model torque of all pole–coil pairs [N·m].
Eigen::Vector3d plainTorque(const ParameterSpace& space,
                            const TorqueCurve& curve,
                            const CalibrationModel::TorqueBlocks& blocks,
                            const EffectPoint& effects,
                            const CoilTerms& terms) {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < space.poles(); ++i) {
    const PoleAxis& pole = space.nominal().poles[i];
    const Eigen::Vector3d pole_rotor =
        space.poleChart(i).axis(blocks.poles[2 * i], blocks.poles[2 * i + 1]);
    const double strength = pole.polarity * pole.gain * effects.poleGain(i);
    for (const CoilTerm& term : terms) {
      if (interacts(curve, pole_rotor, term.coil_rotor)) {
        torque += term.weight * strength * pairTorque(curve, pole_rotor, term.coil_rotor);
      }
    }
  }
  return torque;
}

/// Columns of the strengths for one pair, which exerts `torque` [N·m] in the model.
void addStrengthJacobian(const EffectPoint& effects,
                         const CoilTerm& term,
                         std::size_t pole,
                         const Eigen::Vector3d& torque,
                         RowBlock& d_effects) {
  const EffectLayout& layout = effects.layout();
  if (layout.has(Effect::kStrengthScale)) {
    d_effects.col(layout.first(Effect::kStrengthScale)) -= torque / effects.strengthScale();
  }
  if (layout.has(Effect::kPoleGains)) {
    d_effects.col(layout.first(Effect::kPoleGains) + static_cast<Eigen::Index>(pole)) -=
        torque / effects.poleGain(pole);
  }
  if (term.gain_coordinate >= 0) {
    d_effects.col(term.gain_coordinate) -= torque / term.gain;
  }
}

/// Curves of the single coefficients: the torque curve is linear in them.
void addCurveJacobian(const EffectLayout& layout,
                      const std::vector<TorqueCurve>& basis,
                      const Eigen::Vector3d& pole_rotor,
                      const Eigen::Vector3d& coil_rotor,
                      double weight,
                      RowBlock& d_effects) {
  for (std::size_t n = 0; n < basis.size(); ++n) {
    const Eigen::Index at = layout.first(Effect::kTorqueCurve) + static_cast<Eigen::Index>(n);
    d_effects.col(at) -= weight * layout.unit(at) * pairTorque(basis[n], pole_rotor, coil_rotor);
  }
}

/// The same, with the blocks of poles and of strengths in the residual's Jacobian and each term's
/// ∂T/∂s.
Eigen::Vector3d linearizeTorque(const ParameterSpace& space,
                                const TorqueCurve& curve,
                                const std::vector<TorqueCurve>& curve_basis,
                                const CalibrationModel::TorqueBlocks& blocks,
                                const EffectPoint& effects,
                                CoilTerms& terms,
                                RowBlock& d_effects) {
  const bool wants_effects = d_effects.cols() > 0;
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
    const double strength = pole.polarity * pole.gain * effects.poleGain(i);
    for (CoilTerm& term : terms) {
      if (!interacts(curve, pole_rotor, term.coil_rotor)) {
        continue;
      }
      const double weight = term.weight * strength;
      const PairTorque pair = linearizePairTorque(curve, pole_rotor, term.coil_rotor);
      torque += weight * pair.torque;
      term.d_coil += weight * pair.d_coil;
      if (wants_poles) {
        d_poles.middleCols<2>(static_cast<Eigen::Index>(2 * i)) -= weight * pair.d_pole * d_axis;
      }
      if (wants_effects) {
        addStrengthJacobian(effects, term, i, weight * pair.torque, d_effects);
        addCurveJacobian(
            effects.layout(), curve_basis, pole_rotor, term.coil_rotor, weight, d_effects);
      }
    }
  }
  return torque;
}

/// Columns of the torques that act without current.
void writeLoadJacobian(const Eigen::Matrix3d& R_rotor_stator,
                       const EffectLayout& layout,
                       RowBlock& d_effects) {
  if (layout.has(Effect::kTorqueBias)) {
    const Eigen::Index at = layout.first(Effect::kTorqueBias);
    d_effects.middleCols<3>(at) = -layout.unit(at) * Eigen::Matrix3d::Identity();
  }
  if (layout.has(Effect::kRotorUnbalance)) {
    // c × g = −ĝ c.
    const Eigen::Index at = layout.first(Effect::kRotorUnbalance);
    d_effects.middleCols<3>(at) = layout.unit(at) * skew(R_rotor_stator * gravityDirection());
  }
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
  if (!space_.nominal().hasTorqueModel()) {
    return;
  }
  curve_.emplace(*space_.nominal().torque_curve);
  const Eigen::MatrixXd& shapes = space_.effects().curveShapes();
  for (Eigen::Index n = 0; n < shapes.cols(); ++n) {
    TorqueCurveDescription single = *space_.nominal().torque_curve;
    const Eigen::VectorXd shape = shapes.col(n);
    single.coefficients.assign(shape.begin(), shape.end());
    curve_basis_.emplace_back(single);
  }
}

TorqueCurve CalibrationModel::curveAt(const double* effects) const {
  const Eigen::MatrixXd& shapes = space_.effects().curveShapes();
  const Eigen::Map<const Eigen::VectorXd> shares(
      effects + space_.effects().first(Effect::kTorqueCurve), shapes.cols());
  const Eigen::VectorXd change = shapes * shares;
  TorqueCurveDescription changed = curve_->description();
  for (std::size_t n = 0; n < changed.coefficients.size(); ++n) {
    changed.coefficients[n] += change[static_cast<Eigen::Index>(n)];
  }
  return TorqueCurve(changed);
}

Eigen::Vector3d CalibrationModel::orientationResidual(const Sample& sample,
                                                      const OrientationBlocks& blocks) const {
  const JointPoint point = jointPoint(space_, blocks.joints);
  const EffectPoint effects(space_, blocks.effects);
  const Eigen::Vector3d q = effects.corrected(sample.joint_position);
  const Eigen::Vector3d tracker = effects.vector(Effect::kTrackerRegistration);
  const Eigen::Vector3d marker = effects.vector(Effect::kMarkerRegistration);
  const Eigen::Matrix3d R_tracker = rotationExp(tracker);
  const JointLinearization linear = linearizeRotorOrientation(point.geometry, q);
  const Eigen::Matrix3d R_predicted = R_tracker * linear.R_stator_rotor * rotationExp(marker);
  Eigen::Vector3d y = rotationLog(sample.R_stator_rotor * R_predicted.transpose());
  if (blocks.d_joints.data == nullptr && blocks.d_effects.data == nullptr) {
    return y;
  }
  // R → e^{ξ̂}R turns e^{ŷ} into e^{ŷ}e^{−ξ̂}, and J_r(y) = J_l(−y).
  const Eigen::Matrix3d d_stator = -leftJacobianInverse(-y);
  const Eigen::Matrix3d d_rotation = d_stator * R_tracker;
  if (blocks.d_joints.data != nullptr) {
    writeJointJacobian(point, linear, d_rotation, blocks.d_joints);
  }
  if (blocks.d_effects.data != nullptr) {
    const EffectLayout& layout = space_.effects();
    RowBlock d_effects = mapBlock(blocks.d_effects, layout.size());
    d_effects.setZero();
    effects.writeReadingJacobian(
        sample.joint_position, offsetColumns(linear, d_rotation), d_effects);
    if (layout.has(Effect::kTrackerRegistration)) {
      d_effects.middleCols<3>(layout.first(Effect::kTrackerRegistration)) =
          d_stator * leftJacobian(tracker);
    }
    if (layout.has(Effect::kMarkerRegistration)) {
      d_effects.middleCols<3>(layout.first(Effect::kMarkerRegistration)) =
          d_rotation * linear.R_stator_rotor * leftJacobian(marker);
    }
  }
  return y;
}

Eigen::Vector3d CalibrationModel::torqueResidual(const Sample& sample,
                                                 const std::vector<Excitation>& excitations,
                                                 const TorqueBlocks& blocks) const {
  const bool wants_joints = blocks.d_joints.data != nullptr;
  const bool wants_effects = blocks.d_effects.data != nullptr && space_.effects().size() > 0;
  const JointPoint point = jointPoint(space_, blocks.joints);
  const EffectPoint effects(space_, blocks.effects);
  const Eigen::Vector3d q = effects.corrected(sample.joint_position);
  JointLinearization linear;
  if (wants_joints || wants_effects) {
    linear = linearizeRotorOrientation(point.geometry, q);
  } else {
    linear.R_stator_rotor = rotorOrientation(point.geometry, q);
  }
  const Eigen::Matrix3d R_rotor_stator = linear.R_stator_rotor.transpose();
  CoilTerms terms = coilTerms(space_, excitations, blocks.coils, effects, R_rotor_stator);
  RowBlock d_effects = mapBlock(blocks.d_effects, wants_effects ? space_.effects().size() : 0);
  d_effects.setZero();
  std::optional<TorqueCurve> changed_curve;
  if (space_.effects().has(Effect::kTorqueCurve)) {
    changed_curve.emplace(curveAt(blocks.effects));
  }
  const TorqueCurve& curve = changed_curve ? *changed_curve : *curve_;
  const bool wants_jacobian =
      wants_joints || wants_effects || blocks.d_poles.data != nullptr || blocks.d_coils != nullptr;
  Eigen::Vector3d torque =
      wants_jacobian
          ? linearizeTorque(space_, curve, curve_basis_, blocks, effects, terms, d_effects)
          : plainTorque(space_, curve, blocks, effects, terms);
  // s = Rᵀ s⁰, so ∂s/∂ξ = Rᵀ ŝ⁰ and ∂s/∂s⁰ = Rᵀ; the residual carries the minus sign.
  Eigen::Matrix3d d_rotation = Eigen::Matrix3d::Zero();
  if (wants_joints || wants_effects) {
    for (const CoilTerm& term : terms) {
      d_rotation -= term.d_coil * R_rotor_stator * skew(term.coil_stator);
    }
  }
  torque += effects.vector(Effect::kTorqueBias);
  if (space_.effects().has(Effect::kRotorUnbalance)) {
    // T_g = c × g with g = Rᵀ g⁰, so ∂T_g/∂ξ = ĉ Rᵀ ĝ⁰.
    const Eigen::Matrix3d arm = skew(effects.vector(Effect::kRotorUnbalance));
    torque += arm * R_rotor_stator * gravityDirection();
    d_rotation -= arm * R_rotor_stator * skew(gravityDirection());
  }
  if (wants_joints) {
    writeJointJacobian(point, linear, d_rotation, blocks.d_joints);
  }
  for (std::size_t e = 0; blocks.d_coils != nullptr && e < terms.size(); ++e) {
    if (blocks.d_coils[e].data != nullptr) {
      mapBlock(blocks.d_coils[e], ParameterSpace::kPerAxis) =
          -terms[e].d_coil * R_rotor_stator * terms[e].d_axis;
    }
  }
  if (wants_effects) {
    writeLoadJacobian(R_rotor_stator, effects.layout(), d_effects);
    effects.writeReadingJacobian(
        sample.joint_position, offsetColumns(linear, d_rotation), d_effects);
  }
  return sample.torque - torque;
}

}  // namespace sac
