#include "motion_point.hpp"

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {

MotionPlaces::MotionPlaces(const ParameterSpace& space) {
  for (const PlacedEffect& placed : space.effects().effects()) {
    const Eigen::Index place = space.effect() + placed.first;
    if (placed.name == "rotor_inertia") {
      inertia = place;
    } else if (placed.name == "viscous_friction") {
      viscous = place;
    } else if (placed.name == "coulomb_friction") {
      coulomb = place;
    } else if (placed.name == "current_delay") {
      current_delay = place;
    } else if (placed.name == "current_dispersion") {
      current_dispersion = place;
    } else if (placed.name == "tracker_delay") {
      tracker_delay = place;
    }
  }
}

MotionPoint::MotionPoint(const CalibrationModel& model,
                         const MotionPlaces& places,
                         const Eigen::VectorXd& x)
    : space_(&model.space()), places_(places), x_(x), curve_(&model.curve()) {
  setAxes();
  setStrengths();
  setTurning();
  setInertia();
}

void MotionPoint::setAxes() {
  for (std::size_t k = 0; k < kJoints; ++k) {
    const Eigen::Index at = space_->joint(k);
    const auto column = static_cast<Eigen::Index>(k);
    Eigen::Vector3d axis;
    space_->jointChart(k).evaluate(x_[at + 1], x_[at + 2], axis, d_joint_[k]);
    joints_.axes.col(column) = axis;
    joints_.offsets[column] = space_->nominal().joints[k].offset + x_[at];
  }
  poles_.resize(3, static_cast<Eigen::Index>(space_->poles()));
  coils_.resize(3, static_cast<Eigen::Index>(space_->coils()));
  d_pole_.resize(space_->poles());
  d_coil_.resize(space_->coils());
  Eigen::Vector3d axis;
  for (std::size_t i = 0; i < space_->poles(); ++i) {
    const Eigen::Index at = space_->pole(i);
    space_->poleChart(i).evaluate(x_[at], x_[at + 1], axis, d_pole_[i]);
    poles_.col(static_cast<Eigen::Index>(i)) = axis;
  }
  for (std::size_t j = 0; j < space_->coils(); ++j) {
    const Eigen::Index at = space_->coil(j);
    space_->coilChart(j).evaluate(x_[at], x_[at + 1], axis, d_coil_[j]);
    coils_.col(static_cast<Eigen::Index>(j)) = axis;
  }
}

void MotionPoint::setStrengths() {
  const Actuator& nominal = space_->nominal();
  weight_.resize(poles_.cols(), coils_.cols());
  strengths_.resize(space_->poles() * space_->coils());
  for (std::size_t i = 0; i < space_->poles(); ++i) {
    for (std::size_t j = 0; j < space_->coils(); ++j) {
      double weight = nominal.poles[i].polarity * nominal.poles[i].gain * nominal.coils[j].gain;
      for (const PlacedEffect& placed : space_->effects().effects()) {
        const Eigen::Index n = placed.effect->strengthCoordinate(i, j);
        if (n >= 0) {
          const Eigen::Index place = space_->effect() + placed.first + n;
          const double factor = 1.0 + placed.effect->scale() * x_[place];
          weight *= factor;
          strengths_[i * space_->coils() + j].push_back({place, placed.effect->scale() / factor});
        }
      }
      weight_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = weight;
    }
  }
  for (const PlacedEffect& placed : space_->effects().effects()) {
    if (placed.effect->changesCurve()) {
      Actuator bare;
      bare.torque_curve = curve_->description();
      placed.effect->applyTo(bare, EffectLayout::values(placed, x_.data() + space_->effect()));
      changed_curve_.emplace(*bare.torque_curve);
      curve_ = &*changed_curve_;
    }
  }
}

void MotionPoint::setTurning() {
  for (Eigen::Index p = 0; p < space_->pole(0); ++p) {
    turning_.push_back(p);
  }
  // An effect acts on readings where it does so at one that has nothing special.
  const Eigen::Vector3d anywhere(0.31, -0.23, 0.57);
  for (const PlacedEffect& placed : space_->effects().effects()) {
    Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, placed.size());
    placed.effect->addReadingColumns(anywhere, columns);
    if (columns.isZero(0.0)) {
      continue;
    }
    for (Eigen::Index n = 0; n < placed.size(); ++n) {
      turning_.push_back(space_->effect() + placed.first + n);
    }
  }
}

void MotionPoint::setInertia() {
  Eigen::Matrix<double, 6, 1> values;
  for (Eigen::Index n = 0; n < 6; ++n) {
    values[n] = n < 3 ? RigidRotor().inertia(n, n) : 0.0;
    values[n] += places_.inertia < 0 ? 0.0 : valueAt(places_.inertia + n);
  }
  inertia_ << values[0], values[3], values[4],  //
      values[3], values[1], values[5],          //
      values[4], values[5], values[2];
}

double MotionPoint::valueAt(Eigen::Index place) const {
  return place < 0 ? 0.0 : scaleAt(place) * x_[place];
}

void MotionPoint::turn(const Eigen::Vector3d& reading, TurnedRotor& out) const {
  const Eigen::Index joints = space_->pole(0);
  Eigen::Vector3d q = reading;
  Eigen::Matrix3Xd d_sensors;
  if (static_cast<Eigen::Index>(turning_.size()) > joints) {
    d_sensors.setZero(3, static_cast<Eigen::Index>(turning_.size()) - joints);
    for (std::size_t c = 9; c < turning_.size();) {
      const PlacedEffect& placed = space_->effects().at(turning_[c] - space_->effect());
      auto columns = d_sensors.middleCols(static_cast<Eigen::Index>(c) - joints, placed.size());
      placed.effect->addReadingColumns(reading, columns);
      columns *= placed.effect->scale();
      q += columns * x_.segment(turning_[c], placed.size());
      c += static_cast<std::size_t>(placed.size());
    }
  }
  const JointLinearization linear = linearizeRotorOrientation(joints_, q);
  out.R_stator_rotor = linear.R_stator_rotor;
  out.d_reading = linear.d_offset;
  out.d_x.resize(3, static_cast<Eigen::Index>(turning_.size()));
  for (std::size_t k = 0; k < kJoints; ++k) {
    const Eigen::Index at = space_->joint(k);
    out.d_x.col(at) = linear.d_offset.col(static_cast<Eigen::Index>(k));
    out.d_x.middleCols<2>(at + 1).noalias() = linear.d_axis[k] * d_joint_[k];
  }
  if (d_sensors.cols() > 0) {
    out.d_x.rightCols(d_sensors.cols()).noalias() = linear.d_offset * d_sensors;
  }
}

void MotionPoint::addPair(std::size_t pole,
                          std::size_t coil,
                          double current,
                          const Eigen::Vector3d& pole_stator,
                          const Eigen::Matrix3d& R,
                          StatorTorque& out) const {
  const auto i = static_cast<Eigen::Index>(pole);
  const auto j = static_cast<Eigen::Index>(coil);
  const Eigen::Vector3d coil_stator = coils_.col(j);
  const PairTorque pair = linearizePairTorque(*curve_, pole_stator, coil_stator);
  const double weight = current * weight_(i, j);
  out.d_coil.col(j) += weight_(i, j) * pair.torque;
  out.torque += weight * pair.torque;
  const Eigen::Matrix3d d_pole = weight * pair.d_pole;
  // Only the pole turns with the rotor: r → r + ξ × r.
  out.d_turn.noalias() -= d_pole * skew(pole_stator);
  out.d_x.middleCols<2>(space_->pole(pole)).noalias() += d_pole * (R * d_pole_[pole]);
  out.d_x.middleCols<2>(space_->coil(coil)).noalias() += weight * (pair.d_coil * d_coil_[coil]);
  for (const Strength& strength : strengths_[pole * space_->coils() + coil]) {
    out.d_x.col(strength.coordinate) += (weight * strength.relative) * pair.torque;
  }
  if (!changed_curve_) {
    return;
  }
  for (const PlacedEffect& placed : space_->effects().effects()) {
    if (placed.effect->changesCurve()) {
      Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, placed.size());
      placed.effect->addPairColumns(pole_stator, coil_stator, columns);
      out.d_x.middleCols(space_->effect() + placed.first, placed.size()) +=
          (weight * placed.effect->scale()) * columns;
    }
  }
}

void MotionPoint::addLoads(const Eigen::Matrix3d& R, StatorTorque& out) const {
  const Eigen::Matrix3d R_rotor_stator = R.transpose();
  for (const PlacedEffect& placed : space_->effects().effects()) {
    // A bias of the force/torque sensor is no torque on the rotor.
    if (placed.belongs_to != LaboratoryEffect::BelongsTo::kLoad) {
      continue;
    }
    Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, placed.size());
    placed.effect->addLoadColumns(R_rotor_stator, columns);
    const Eigen::VectorXd values = EffectLayout::values(placed, x_.data() + space_->effect());
    const Eigen::Matrix3Xd turned = R * columns;
    const Eigen::Vector3d load = turned * values;
    out.torque += load;
    out.d_turn += R * placed.effect->loadRotation(values, R_rotor_stator) - skew(load);
    out.d_x.middleCols(space_->effect() + placed.first, placed.size()) +=
        placed.effect->scale() * turned;
  }
}

void MotionPoint::torque(const Eigen::Matrix3d& R_stator_rotor,
                         const Eigen::VectorXd& current,
                         StatorTorque& out) const {
  out.torque.setZero();
  out.d_turn.setZero();
  out.d_x.setZero(3, space_->size());
  out.d_coil.setZero(3, coils_.cols());
  const Eigen::Matrix3Xd poles_stator = R_stator_rotor * poles_;
  const Eigen::MatrixXd cosines = poles_stator.transpose() * coils_;
  for (Eigen::Index j = 0; j < coils_.cols(); ++j) {
    for (Eigen::Index i = 0; i < poles_.cols(); ++i) {
      if (cosines(i, j) > curve_->cosSupportEnd()) {
        addPair(static_cast<std::size_t>(i),
                static_cast<std::size_t>(j),
                current[j],
                poles_stator.col(i),
                R_stator_rotor,
                out);
      }
    }
  }
  addLoads(R_stator_rotor, out);
}

}  // namespace sac
