#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

#include <array>
#include <cmath>
#include <utility>

#include <boost/container/small_vector.hpp>

#include "effects_at.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// Joint axes and offsets at the coordinates, with ∂axis/∂(u, v) of each. Corrections of readings
/// and the orientation map act apart from them, on what the sensors read.
struct JointPoint {
  JointGeometry geometry;
  std::array<Eigen::Matrix<double, 3, 2>, kJoints> d_axis;
};

JointPoint jointPoint(const ParameterSpace& space, const Eigen::VectorXd& x) {
  JointPoint point;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const Eigen::Index at = space.joint(k);
    const auto column = static_cast<Eigen::Index>(k);
    Eigen::Vector3d axis;
    space.jointChart(k).evaluate(x[at + 1], x[at + 2], axis, point.d_axis[k]);
    point.geometry.axes.col(column) = axis;
    point.geometry.offsets[column] = space.nominal().joints[k].offset + x[at];
  }
  return point;
}

/// What turns the rotor beside the joints of the nominal actuator.
Eigen::Matrix3d nominalTurn(const Actuator& nominal, const Eigen::Vector3d& reading) {
  return nominal.orientation_map ? rotationExp(nominal.orientation_map->mean(reading))
                                 : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

/// left · ∂ξ/∂(offset, u, v of each joint) into the columns of the joints.
void writeJointJacobian(const JointPoint& point,
                        const JointLinearization& linear,
                        const Eigen::Matrix3d& left,
                        ResidualJacobian& jacobian) {
  for (std::size_t k = 0; k < kJoints; ++k) {
    const auto first = ParameterSpace::kPerJoint * static_cast<Eigen::Index>(k);
    jacobian.col(first) = left * linear.d_offset.col(static_cast<Eigen::Index>(k));
    jacobian.middleCols<2>(first + 1) = left * (linear.d_axis[k] * point.d_axis[k]);
  }
}

/// left · ∂ξ/∂offset of each joint. An error of a reading acts as an offset of that joint does.
Eigen::Matrix3d offsetColumns(const JointLinearization& linear, const Eigen::Matrix3d& left) {
  Eigen::Matrix3d columns;
  for (Eigen::Index k = 0; k < 3; ++k) {
    columns.col(k) = left * linear.d_offset.col(k);
  }
  return columns;
}

/// One excited coil while the torques of its pairs are summed up.
struct CoilTerm {
  std::size_t coil = 0;
  double current = 0.0;  ///< times the nominal gain [A]
  Eigen::Vector3d coil_stator;
  Eigen::Vector3d coil_rotor;
  Eigen::Matrix<double, 3, 2> d_axis;                ///< ∂s⁰/∂(u, v)
  Eigen::Matrix3d d_coil = Eigen::Matrix3d::Zero();  ///< ∂T/∂s
};

using CoilTerms = boost::container::small_vector<CoilTerm, 8>;

CoilTerms coilTerms(const ParameterSpace& space,
                    const std::vector<Excitation>& excitations,
                    const Eigen::VectorXd& x,
                    const Eigen::Matrix3d& R_rotor_stator) {
  CoilTerms terms(excitations.size());
  for (std::size_t e = 0; e < excitations.size(); ++e) {
    CoilTerm& term = terms[e];
    term.coil = excitations[e].coil;
    const Eigen::Index at = space.coil(term.coil);
    space.coilChart(term.coil).evaluate(x[at], x[at + 1], term.coil_stator, term.d_axis);
    term.coil_rotor = R_rotor_stator * term.coil_stator;
    term.current = excitations[e].current * space.nominal().coils[term.coil].gain;
  }
  return terms;
}

/// Model torque of all pole–coil pairs [N·m].
Eigen::Vector3d pairTorques(const ParameterSpace& space,
                            const TorqueCurve& curve,
                            const Eigen::VectorXd& x,
                            const EffectsAt& effects,
                            const CoilTerms& terms) {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < space.poles(); ++i) {
    const PoleAxis& pole = space.nominal().poles[i];
    const Eigen::Index at = space.pole(i);
    const Eigen::Vector3d pole_rotor = space.poleChart(i).axis(x[at], x[at + 1]);
    for (const CoilTerm& term : terms) {
      if (interacts(curve, pole_rotor, term.coil_rotor)) {
        const double weight =
            term.current * pole.polarity * pole.gain * effects.strength(i, term.coil);
        torque += weight * pairTorque(curve, pole_rotor, term.coil_rotor);
      }
    }
  }
  return torque;
}

/// The same, with the columns of poles and of strengths in the residual's Jacobian and each term's
/// ∂T/∂s. `d_effects`: 3×E, by values of the effects.
Eigen::Vector3d linearizePairTorques(const ParameterSpace& space,
                                     const TorqueCurve& curve,
                                     const Eigen::VectorXd& x,
                                     const EffectsAt& effects,
                                     CoilTerms& terms,
                                     ResidualJacobian& jacobian,
                                     Eigen::Matrix3Xd& d_effects) {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < space.poles(); ++i) {
    const PoleAxis& pole = space.nominal().poles[i];
    const Eigen::Index at = space.pole(i);
    Eigen::Vector3d pole_rotor;
    Eigen::Matrix<double, 3, 2> d_axis;
    space.poleChart(i).evaluate(x[at], x[at + 1], pole_rotor, d_axis);
    for (CoilTerm& term : terms) {
      if (!interacts(curve, pole_rotor, term.coil_rotor)) {
        continue;
      }
      const double weight =
          term.current * pole.polarity * pole.gain * effects.strength(i, term.coil);
      const PairTorque pair = linearizePairTorque(curve, pole_rotor, term.coil_rotor);
      torque += weight * pair.torque;
      term.d_coil += weight * pair.d_coil;
      jacobian.middleCols<2>(at) -= weight * pair.d_pole * d_axis;
      effects.subtractStrengthColumns(i, term.coil, weight * pair.torque, d_effects);
      effects.subtractPairColumns(pole_rotor, term.coil_rotor, weight, d_effects);
    }
  }
  return torque;
}

/// A measured torque in the rotor's frame, T_measured = e^{ẑ} T, and its ∂/∂values of the effects.
Eigen::Vector3d torqueInRotor(const Eigen::Vector3d& measured,
                              const EffectsAt& effects,
                              Eigen::Matrix3Xd* d_effects) {
  if (effects.empty()) {
    return measured;
  }
  const Eigen::Matrix3Xd d_frame = effects.torqueFrameColumns();
  const Eigen::Vector3d frame = d_frame * effects.values();
  const Eigen::Matrix3d back = rotationExp(-frame);
  if (d_effects != nullptr) {
    *d_effects += back * skew(measured) * leftJacobian(frame) * d_frame;
  }
  return back * measured;
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

CalibrationModel::CalibrationModel(ParameterSpace space)
    : space_(std::move(space)), nominal_joints_(jointGeometry(space_.nominal())) {
  if (space_.nominal().hasTorqueModel()) {
    curve_.emplace(*space_.nominal().torque_curve);
  }
}

Eigen::Vector3d CalibrationModel::orientationResidual(const Sample& sample,
                                                      const Eigen::VectorXd& x,
                                                      ResidualJacobian* jacobian) const {
  const JointPoint point = jointPoint(space_, x);
  const EffectsAt effects(space_, x);
  const Eigen::Matrix3Xd d_reading = effects.readingColumns(sample.joint_position);
  const Eigen::Matrix3Xd d_tracker = effects.trackerColumns();
  const Eigen::Matrix3Xd d_marker = effects.markerColumns();
  const Eigen::Vector3d tracker = d_tracker * effects.values();
  const Eigen::Vector3d marker = d_marker * effects.values();
  const Eigen::Matrix3d R_left =
      rotationExp(tracker) * nominalTurn(space_.nominal(), sample.joint_position);
  const JointLinearization linear = linearizeRotorOrientation(
      point.geometry,
      correctedReading(nominal_joints_, sample.joint_position) + d_reading * effects.values());
  const Eigen::Matrix3d R_predicted = R_left * linear.R_stator_rotor * rotationExp(marker);
  Eigen::Vector3d y = rotationLog(sample.R_stator_rotor * R_predicted.transpose());
  if (jacobian == nullptr) {
    return y;
  }
  // R → e^{ξ̂}R turns e^{ŷ} into e^{ŷ}e^{−ξ̂}, and J_r(y) = J_l(−y).
  const Eigen::Matrix3d d_stator = -leftJacobianInverse(-y);
  const Eigen::Matrix3d d_rotation = d_stator * R_left;
  jacobian->setZero(3, space_.size());
  writeJointJacobian(point, linear, d_rotation, *jacobian);
  if (!effects.empty()) {
    const Eigen::Matrix3d d_rotor = d_rotation * linear.R_stator_rotor * leftJacobian(marker);
    effects.write(offsetColumns(linear, d_rotation) * d_reading +
                      d_stator * leftJacobian(tracker) * d_tracker + d_rotor * d_marker,
                  *jacobian);
  }
  return y;
}

Eigen::Vector3d CalibrationModel::torqueResidual(const Sample& sample,
                                                 const std::vector<Excitation>& excitations,
                                                 const Eigen::VectorXd& x,
                                                 ResidualJacobian* jacobian) const {
  const JointPoint point = jointPoint(space_, x);
  const EffectsAt effects(space_, x);
  const Eigen::Matrix3Xd d_reading = effects.readingColumns(sample.joint_position);
  const Eigen::Vector3d q =
      correctedReading(nominal_joints_, sample.joint_position) + d_reading * effects.values();
  const Eigen::Matrix3d R_turn = nominalTurn(space_.nominal(), sample.joint_position);
  const std::optional<TorqueCurve> changed_curve = effects.changedCurve();
  const TorqueCurve& curve = changed_curve ? *changed_curve : *curve_;
  if (jacobian == nullptr) {
    const Eigen::Matrix3d R_rotor_stator =
        (R_turn * rotorOrientation(point.geometry, q)).transpose();
    const CoilTerms terms = coilTerms(space_, excitations, x, R_rotor_stator);
    return torqueInRotor(sample.torque, effects, nullptr) -
           pairTorques(space_, curve, x, effects, terms) -
           effects.loadColumns(R_rotor_stator) * effects.values();
  }
  const JointLinearization linear = linearizeRotorOrientation(point.geometry, q);
  const Eigen::Matrix3d R_rotor_stator = (R_turn * linear.R_stator_rotor).transpose();
  CoilTerms terms = coilTerms(space_, excitations, x, R_rotor_stator);
  const Eigen::Matrix3Xd d_load = effects.loadColumns(R_rotor_stator);
  Eigen::Matrix3Xd d_effects = -d_load;
  jacobian->setZero(3, space_.size());
  const Eigen::Vector3d torque =
      linearizePairTorques(space_, curve, x, effects, terms, *jacobian, d_effects) +
      d_load * effects.values();
  const Eigen::Vector3d measured = torqueInRotor(sample.torque, effects, &d_effects);
  // s = Rᵀ s⁰, so ∂s/∂ξ = Rᵀ ŝ⁰ and ∂s/∂s⁰ = Rᵀ; the residual carries the minus sign.
  Eigen::Matrix3d d_rotation = -effects.loadRotation(R_rotor_stator);
  for (const CoilTerm& term : terms) {
    const Eigen::Matrix3d d_stator = -term.d_coil * R_rotor_stator;
    d_rotation += d_stator * skew(term.coil_stator);
    jacobian->middleCols<2>(space_.coil(term.coil)) = d_stator * term.d_axis;
  }
  d_rotation = (d_rotation * R_turn).eval();
  writeJointJacobian(point, linear, d_rotation, *jacobian);
  if (!effects.empty()) {
    effects.write(d_effects + offsetColumns(linear, d_rotation) * d_reading, *jacobian);
  }
  return measured - torque;
}

}  // namespace sac
