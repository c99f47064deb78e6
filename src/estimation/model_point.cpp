#include "spherical_actuator_calibration/estimation/model_point.hpp"

#include <optional>

#include <boost/container/small_vector.hpp>

#include "axis_point.hpp"
#include "effects_at.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/estimation/joint_point.hpp"

namespace sac {
namespace {

/// What the effects do that act so. `columns`: ∂/∂their values.
Eigen::Vector3d applied(const Eigen::Matrix3Xd& columns, const ActingEffects& acting) {
  // Of a matrix without columns Eigen forms addresses that are none.
  return acting.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                        : Eigen::Vector3d(columns * acting.values);
}

Eigen::Matrix3d minus() {
  return -Eigen::Matrix3d::Identity();
}

/// left · ∂ξ/∂offset of each joint. An error of a reading acts as an offset of that joint does.
Eigen::Matrix3d offsetColumns(const JointPoint::Linearized& linear, const Eigen::Matrix3d& left) {
  Eigen::Matrix3d columns;
  for (Eigen::Index k = 0; k < 3; ++k) {
    columns.col(k) = left * linear.d_coordinates.col(ParameterSpace::kPerJoint * k);
  }
  return columns;
}

/// One excited coil while the torques of its pairs are summed up.
struct CoilTerm {
  std::size_t coil = 0;
  double current = 0.0;  ///< times the nominal gain [A]
  const AxisPoint* axis = nullptr;
  Eigen::Vector3d coil_rotor;
  Eigen::Matrix3d d_coil = Eigen::Matrix3d::Zero();  ///< ∂T/∂s
};

using CoilTerms = boost::container::small_vector<CoilTerm, 8>;

}  // namespace

struct ModelPoint::Parts {
  /// A rotation by the effects that act on it, e^{v̂}, and ∂v/∂their values.
  struct EffectRotation {
    EffectRotation(const Eigen::Matrix3Xd& columns, const ActingEffects& acting)
        : d_vector(columns), vector(applied(columns, acting)), rotation(rotationExp(vector)) {}

    Eigen::Matrix3Xd d_vector;
    Eigen::Vector3d vector;
    Eigen::Matrix3d rotation;
  };

  Parts(const CalibrationModel& model, const Eigen::VectorXd& x);

  bool hasJoints() const { return space.joints() > 0; }
  Eigen::Matrix3d nominalTurn(const Eigen::Vector3d& reading) const;
  Eigen::Matrix3d turnedLeft(const Eigen::Vector3d& reading) const;
  Eigen::Matrix3d turnedRight(const Eigen::Matrix3d& R_stator_rotor) const;
  void addReadingColumns(const Eigen::Matrix3d& d_rotation,
                         const Eigen::Matrix3d& d_offsets,
                         const Eigen::Matrix3d& R_stator_rotor,
                         const Eigen::Matrix3Xd& d_reading,
                         ResidualJacobian& jacobian) const;
  Eigen::Vector3d corrected(const Eigen::Vector3d& reading, const Eigen::Matrix3Xd& columns) const;
  CoilTerms coilTerms(Excitations excitations, const Eigen::Matrix3d& R_rotor_stator) const;
  Eigen::Vector3d pairTorques(const CoilTerms& terms) const;
  Eigen::Vector3d linearizePairTorques(CoilTerms& terms, ResidualJacobian& jacobian) const;
  Eigen::Vector3d torqueInRotor(const Eigen::Vector3d& measured, ResidualJacobian* jacobian) const;

  /// Torque per ampere of a pair by its strength, that of the coil apart.
  double poleStrength(std::size_t pole, std::size_t coil) const {
    const PoleAxis& nominal = space.nominal().poles[pole];
    return nominal.polarity * nominal.gain * effects.strength(pole, coil);
  }

  const ParameterSpace& space;
  JointGeometry nominal_joints;
  JointPoint joints;
  std::vector<AxisPoint> poles;  ///< rotor frame
  std::vector<AxisPoint> coils;  ///< stator frame
  EffectsAt effects;
  EffectRotation tracker;
  EffectRotation marker;
  EffectRotation torque_frame;  ///< of the force/torque sensor in the rotor
  std::optional<TorqueCurve> changed_curve;
  const TorqueCurve* curve = nullptr;  ///< null: no torque model
};

ModelPoint::Parts::Parts(const CalibrationModel& model, const Eigen::VectorXd& x)
    : space(model.space()),
      nominal_joints(jointGeometry(space.nominal())),
      joints(space, x),
      effects(space, x),
      tracker(effects.trackerColumns(), effects.onTracker()),
      marker(effects.markerColumns(), effects.onMarker()),
      torque_frame(effects.torqueFrameColumns(), effects.onTorqueFrame()) {
  poles.reserve(space.poles());
  for (std::size_t i = 0; i < space.poles(); ++i) {
    poles.push_back(axisPoint(space.poleChart(i), x.data() + space.pole(i)));
  }
  coils.reserve(space.coils());
  for (std::size_t j = 0; j < space.coils(); ++j) {
    coils.push_back(axisPoint(space.coilChart(j), x.data() + space.coil(j)));
  }
  if (model.hasTorqueModel()) {
    changed_curve = effects.changedCurve();
    curve = changed_curve ? &*changed_curve : &model.curve();
  }
}

/// What turns the rotor beside the joints of the nominal actuator.
Eigen::Matrix3d ModelPoint::Parts::nominalTurn(const Eigen::Vector3d& reading) const {
  const auto& map = space.nominal().orientation_map;
  return map ? rotationExp(map->mean(reading)) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

/// What turns the rotor in the stator beside the reading: of joints the map, of a tracker the
/// inverse of its registration.
Eigen::Matrix3d ModelPoint::Parts::turnedLeft(const Eigen::Vector3d& reading) const {
  return hasJoints() ? nominalTurn(reading) : Eigen::Matrix3d(tracker.rotation.transpose());
}

/// The rotor where its marker is told.
Eigen::Matrix3d ModelPoint::Parts::turnedRight(const Eigen::Matrix3d& R_stator_rotor) const {
  return hasJoints() ? R_stator_rotor
                     : Eigen::Matrix3d(R_stator_rotor * marker.rotation.transpose());
}

/// Adds ∂residual/∂values of the effects on the orientation. `d_rotation`: by ξ of the rotor;
/// `d_offsets`: by offsets of the joints; `d_reading`: ∂q/∂values.
void ModelPoint::Parts::addReadingColumns(const Eigen::Matrix3d& d_rotation,
                                          const Eigen::Matrix3d& d_offsets,
                                          const Eigen::Matrix3d& R_stator_rotor,
                                          const Eigen::Matrix3Xd& d_reading,
                                          ResidualJacobian& jacobian) const {
  if (hasJoints()) {
    effects.add(effects.onReadings(), d_offsets, d_reading, jacobian);
    return;
  }
  // The tracker's rotation acts by its inverse and from the left, e^{−(t + δ)^}, and e^{−(m + δ)^}
  // = e^{−m̂} e^{−(J_l(m) δ)^}, which turns R from the right.
  effects.add(
      effects.onTracker(), -d_rotation * leftJacobian(-tracker.vector), tracker.d_vector, jacobian);
  effects.add(effects.onMarker(),
              -d_rotation * R_stator_rotor * leftJacobian(marker.vector),
              marker.d_vector,
              jacobian);
}

/// Joint angles at a reading. `columns`: ∂ of them by the values of the effects on readings.
Eigen::Vector3d ModelPoint::Parts::corrected(const Eigen::Vector3d& reading,
                                             const Eigen::Matrix3Xd& columns) const {
  return correctedReading(nominal_joints, reading) + applied(columns, effects.onReadings());
}

CoilTerms ModelPoint::Parts::coilTerms(Excitations excitations,
                                       const Eigen::Matrix3d& R_rotor_stator) const {
  CoilTerms terms(excitations.size());
  for (std::size_t e = 0; e < excitations.size(); ++e) {
    CoilTerm& term = terms[e];
    term.coil = excitations[e].coil;
    term.axis = &coils[term.coil];
    term.coil_rotor = R_rotor_stator * term.axis->axis;
    term.current = excitations[e].current * space.nominal().coils[term.coil].gain;
  }
  return terms;
}

/// Model torque of all pole–coil pairs [N·m].
Eigen::Vector3d ModelPoint::Parts::pairTorques(const CoilTerms& terms) const {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < poles.size(); ++i) {
    for (const CoilTerm& term : terms) {
      if (interacts(*curve, poles[i].axis, term.coil_rotor)) {
        torque += term.current * poleStrength(i, term.coil) *
                  pairTorque(*curve, poles[i].axis, term.coil_rotor);
      }
    }
  }
  return torque;
}

/// The same, with the columns of poles, of strengths and of the curve in the residual's Jacobian
/// and each term's ∂T/∂s.
Eigen::Vector3d ModelPoint::Parts::linearizePairTorques(CoilTerms& terms,
                                                        ResidualJacobian& jacobian) const {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd d_curve = Eigen::Matrix3Xd::Zero(3, effects.onCurve().size());
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const auto& [pole_rotor, d_axis] = poles[i];
    for (CoilTerm& term : terms) {
      if (!interacts(*curve, pole_rotor, term.coil_rotor)) {
        continue;
      }
      const double weight = term.current * poleStrength(i, term.coil);
      const PairTorque pair = linearizePairTorque(*curve, pole_rotor, term.coil_rotor);
      torque += weight * pair.torque;
      term.d_coil += weight * pair.d_coil;
      jacobian.middleCols<2>(space.pole(i)) -= weight * pair.d_pole * d_axis;
      effects.subtractStrengthColumns(i, term.coil, weight * pair.torque, jacobian);
      effects.addPairColumns(pole_rotor, term.coil_rotor, weight, d_curve);
    }
  }
  effects.add(effects.onCurve(), minus(), d_curve, jacobian);
  return torque;
}

/// A measured torque in the rotor's frame, T_measured = e^{ẑ} T; adds its ∂/∂values of the effects.
Eigen::Vector3d ModelPoint::Parts::torqueInRotor(const Eigen::Vector3d& measured,
                                                 ResidualJacobian* jacobian) const {
  if (effects.onTorqueFrame().empty()) {
    return measured;
  }
  const Eigen::Matrix3d back = torque_frame.rotation.transpose();
  if (jacobian != nullptr) {
    effects.add(effects.onTorqueFrame(),
                back * skew(measured) * leftJacobian(torque_frame.vector),
                torque_frame.d_vector,
                *jacobian);
  }
  return back * measured;
}

ModelPoint::ModelPoint(const CalibrationModel& model, const Eigen::VectorXd& x)
    : parts_(std::make_shared<const Parts>(model, x)) {}

Eigen::Vector3d ModelPoint::orientationResidual(const Sample& sample,
                                                ResidualJacobian* jacobian,
                                                PoseDerivatives* d_pose) const {
  const Parts& at = *parts_;
  const Eigen::Matrix3Xd d_reading = at.effects.readingColumns(sample.joint_position);
  const Eigen::Vector3d q = at.corrected(sample.joint_position, d_reading);
  const Eigen::Matrix3d R_left = at.tracker.rotation * at.nominalTurn(sample.joint_position);
  if (jacobian == nullptr) {
    const Eigen::Matrix3d R_predicted = R_left * at.joints.orientation(q) * at.marker.rotation;
    return rotationLog(sample.R_stator_rotor * R_predicted.transpose());
  }
  const JointPoint::Linearized linear = at.joints.linearized(q);
  const Eigen::Matrix3d R_predicted = R_left * linear.R_stator_rotor * at.marker.rotation;
  Eigen::Vector3d y = rotationLog(sample.R_stator_rotor * R_predicted.transpose());
  // R → e^{ξ̂}R turns e^{ŷ} into e^{ŷ}e^{−ξ̂}, and J_r(y) = J_l(−y).
  const Eigen::Matrix3d d_stator = -leftJacobianInverse(-y);
  const Eigen::Matrix3d d_rotation = d_stator * R_left;
  jacobian->setZero(3, at.space.size());
  jacobian->leftCols<JointPoint::kCoordinates>() = d_rotation * linear.d_coordinates;
  if (d_pose != nullptr) {
    // A joint sensor's error acts as an offset of that joint does.
    *d_pose = {offsetColumns(linear, d_rotation), d_stator * at.tracker.rotation};
  }
  if (!at.effects.empty()) {
    const Eigen::Matrix3d d_rotor =
        d_rotation * linear.R_stator_rotor * leftJacobian(at.marker.vector);
    at.effects.add(
        at.effects.onReadings(), offsetColumns(linear, d_rotation), d_reading, *jacobian);
    at.effects.add(at.effects.onTracker(),
                   d_stator * leftJacobian(at.tracker.vector),
                   at.tracker.d_vector,
                   *jacobian);
    at.effects.add(at.effects.onMarker(), d_rotor, at.marker.d_vector, *jacobian);
  }
  return y;
}

Eigen::Matrix3d ModelPoint::orientation(const Sample& sample) const {
  const Parts& at = *parts_;
  const Eigen::Vector3d& reading = sample.joint_position;
  const Eigen::Vector3d q = at.corrected(reading, at.effects.readingColumns(reading));
  return at.turnedRight(at.turnedLeft(reading) * at.joints.orientation(q));
}

Eigen::Vector3d ModelPoint::torqueResidual(const Sample& sample,
                                           Excitations excitations,
                                           ResidualJacobian* jacobian,
                                           PoseDerivatives* d_pose) const {
  const Parts& at = *parts_;
  if (jacobian == nullptr) {
    const Eigen::Matrix3d R_rotor_stator = orientation(sample).transpose();
    const Eigen::Vector3d residual = at.torqueInRotor(sample.torque, nullptr) -
                                     at.pairTorques(at.coilTerms(excitations, R_rotor_stator));
    return at.effects.onLoad().empty()
               ? residual
               : Eigen::Vector3d(residual - applied(at.effects.loadColumns(R_rotor_stator),
                                                    at.effects.onLoad()));
  }
  const Eigen::Matrix3Xd d_corrections = at.effects.readingColumns(sample.joint_position);
  const Eigen::Vector3d q = at.corrected(sample.joint_position, d_corrections);
  const Eigen::Matrix3d R_left = at.turnedLeft(sample.joint_position);
  const JointPoint::Linearized linear = at.joints.linearized(q);
  const Eigen::Matrix3d R_stator_rotor = at.turnedRight(R_left * linear.R_stator_rotor);
  const Eigen::Matrix3d R_rotor_stator = R_stator_rotor.transpose();
  CoilTerms terms = at.coilTerms(excitations, R_rotor_stator);
  const Eigen::Matrix3Xd d_load = at.effects.loadColumns(R_rotor_stator);
  jacobian->setZero(3, at.space.size());
  at.effects.add(at.effects.onLoad(), minus(), d_load, *jacobian);
  const Eigen::Vector3d torque =
      at.linearizePairTorques(terms, *jacobian) + applied(d_load, at.effects.onLoad());
  const Eigen::Vector3d measured = at.torqueInRotor(sample.torque, jacobian);
  // s = Rᵀ s⁰, so ∂s/∂ξ = Rᵀ ŝ⁰ and ∂s/∂s⁰ = Rᵀ; the residual carries the minus sign.
  Eigen::Matrix3d d_rotation = -at.effects.loadRotation(R_rotor_stator);
  for (const CoilTerm& term : terms) {
    const Eigen::Matrix3d d_stator = -term.d_coil * R_rotor_stator;
    d_rotation += d_stator * skew(term.axis->axis);
    jacobian->middleCols<2>(at.space.coil(term.coil)) = d_stator * term.axis->d_axis;
  }
  // Of a reading's errors those of joints act as offsets do, those of a tracker turn what it reads.
  const Eigen::Matrix3d d_left = d_rotation * R_left;
  const Eigen::Matrix3d d_offsets = at.hasJoints() ? offsetColumns(linear, d_left) : d_left;
  if (at.hasJoints()) {
    jacobian->leftCols<JointPoint::kCoordinates>() = d_left * linear.d_coordinates;
  }
  if (d_pose != nullptr) {
    d_pose->reading = d_offsets;
    d_pose->rotation = at.hasJoints() ? d_rotation : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
  }
  if (!at.effects.empty()) {
    at.addReadingColumns(d_rotation, d_offsets, R_stator_rotor, d_corrections, *jacobian);
  }
  return measured - torque;
}

// The model itself knows no points, so that it can be used without them: at single ones it is here.

Eigen::Vector3d CalibrationModel::orientationResidual(const Sample& sample,
                                                      const Eigen::VectorXd& x,
                                                      ResidualJacobian* jacobian) const {
  return ModelPoint(*this, x).orientationResidual(sample, jacobian);
}

Eigen::Vector3d CalibrationModel::torqueResidual(const Sample& sample,
                                                 const std::vector<Excitation>& excitations,
                                                 const Eigen::VectorXd& x,
                                                 ResidualJacobian* jacobian) const {
  return ModelPoint(*this, x).torqueResidual(sample, excitations, jacobian);
}

}  // namespace sac
