#include "motion_point.hpp"

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"

namespace sac {

MotionPlaces::MotionPlaces(const ParameterSpace& space) {
  for (const PlacedEffect& placed : space.effects().effects()) {
    const Eigen::Index place = space.effect() + placed.first;
    if (placed.name == effect_name::kRotorInertia) {
      inertia = place;
    } else if (placed.name == effect_name::kViscousFriction) {
      viscous = place;
    } else if (placed.name == effect_name::kCoulombFriction) {
      coulomb = place;
    } else if (placed.name == effect_name::kCurrentDelay) {
      current_delay = place;
    } else if (placed.name == effect_name::kCurrentDispersion) {
      current_dispersion = place;
    } else if (placed.name == effect_name::kTrackerDelay) {
      tracker_delay = place;
    }
  }
}

MotionPoint::MotionPoint(const CalibrationModel& model,
                         const MotionPlaces& places,
                         const Eigen::VectorXd& x,
                         const TabulatedCurve* tabulated)
    : space_(&model.space()),
      places_(places),
      x_(x),
      curve_(&model.curve()),
      tabulated_(tabulated),
      joints_(model.space(), x),
      nominal_joints_(jointGeometry(model.space().nominal())) {
  setScales();
  setAxes();
  setStrengths();
  setLoads();
  setTurning();
  setInertia();
}

void MotionPoint::setScales() {
  scales_.setOnes(space_->size());
  for (Eigen::Index e = 0; e < space_->effects().size(); ++e) {
    scales_[space_->effect() + e] = space_->effects().scale(e);
  }
}

void MotionPoint::setAxes() {
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
  coils_by_row_ = coils_.transpose();
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
      tabulated_ = nullptr;
    }
  }
}

void MotionPoint::setLoads() {
  for (const PlacedEffect& placed : space_->effects().effects()) {
    // A bias of the force/torque sensor is no torque on the rotor.
    if (placed.belongs_to == LaboratoryEffect::BelongsTo::kLoad) {
      loads_.push_back({&placed, EffectLayout::values(placed, x_.data() + space_->effect())});
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
  constexpr auto kGeometry = static_cast<std::size_t>(JointPoint::kCoordinates);
  Eigen::Vector3d q = correctedReading(nominal_joints_, reading);
  Eigen::Matrix3Xd d_sensors;
  if (turning_.size() > kGeometry) {
    d_sensors.setZero(3, static_cast<Eigen::Index>(turning_.size() - kGeometry));
    for (std::size_t c = kGeometry; c < turning_.size();) {
      const PlacedEffect& placed = space_->effects().at(turning_[c] - space_->effect());
      auto columns = d_sensors.middleCols(static_cast<Eigen::Index>(c - kGeometry), placed.size());
      placed.effect->addReadingColumns(reading, columns);
      columns *= placed.effect->scale();
      q += columns * x_.segment(turning_[c], placed.size());
      c += static_cast<std::size_t>(placed.size());
    }
  }
  const JointPoint::Linearized linear = joints_.linearized(q);
  out.R_stator_rotor = linear.R_stator_rotor;
  out.d_x.resize(3, static_cast<Eigen::Index>(turning_.size()));
  out.d_x.leftCols<JointPoint::kCoordinates>() = linear.d_coordinates;
  if (nominal_joints_.map) {
    const Eigen::Matrix3d beside = rotationExp(nominal_joints_.map->mean(reading));
    out.R_stator_rotor = beside * linear.R_stator_rotor;
    out.d_x.leftCols<JointPoint::kCoordinates>() = beside * linear.d_coordinates;
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    out.d_reading.col(static_cast<Eigen::Index>(k)) = out.d_x.col(space_->joint(k));
  }
  if (d_sensors.cols() > 0) {
    out.d_x.rightCols(d_sensors.cols()).noalias() = out.d_reading * d_sensors;
  }
}

/// Strengths and torque curve, where they are modelled. `torque`: of the pair [N·m/A].
void MotionPoint::addEffects(std::size_t pole,
                             std::size_t coil,
                             double weight,
                             const Eigen::Vector3d& pole_stator,
                             const Eigen::Vector3d& torque,
                             StatorTorque& out) const {
  for (const Strength& strength : strengths_[pole * space_->coils() + coil]) {
    out.d_x.col(strength.coordinate) += (weight * strength.relative) * torque;
  }
  if (!changed_curve_) {
    return;
  }
  const Eigen::Vector3d coil_stator = coils_.col(static_cast<Eigen::Index>(coil));
  for (const PlacedEffect& placed : space_->effects().effects()) {
    if (placed.effect->changesCurve()) {
      Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, placed.size());
      placed.effect->addPairColumns(pole_stator, coil_stator, columns);
      out.d_x.middleCols(space_->effect() + placed.first, placed.size()) +=
          (weight * placed.effect->scale()) * columns;
    }
  }
}

/// Of some two hundred pairs a dozen are near. The processor works at several of them at a time, as
/// long as nothing between them has to be guessed.
void MotionPoint::findPairs(const Eigen::Matrix3d& R, StatorTorque& out) const {
  out.poles.noalias() = R * poles_;
  out.cosines.noalias() = coils_by_row_ * out.poles;
  out.pairs.resize(static_cast<std::size_t>(out.cosines.size()));
  out.near = 0;
  for (Eigen::Index i = 0; i < poles_.cols(); ++i) {
    for (Eigen::Index j = 0; j < coils_.cols(); ++j) {
      out.pairs[out.near].pole = i;
      out.pairs[out.near].coil = j;
      out.near += out.cosines(j, i) > curve_->cosSupportEnd() ? 1 : 0;
    }
  }
  for (std::size_t n = 0; n < out.near; ++n) {
    NearPair& pair = out.pairs[n];
    pair.cross = out.poles.col(pair.pole).cross(coils_.col(pair.coil));
    const double kappa = out.cosines(pair.coil, pair.pole);
    pair.curve = tabulated_ ? tabulated_->at(kappa) : curve_->safe(kappa, pair.cross.norm());
  }
}

/// The pole of the pair `first`, with all coils near it, as linearizePairTorque(); returns the
/// first pair of the next pole. A coil meets one pole or two at a time, so its axis is turned into
/// coordinates with each pair; that of the pole once for all pairs.
std::size_t MotionPoint::addPole(std::size_t first,
                                 const Eigen::Matrix3d& R,
                                 const Eigen::VectorXd& current,
                                 StatorTorque& out) const {
  const Eigen::Index i = out.pairs[first].pole;
  const auto pole = static_cast<std::size_t>(i);
  const Eigen::Vector3d r = out.poles.col(i);
  Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  std::size_t n = first;
  for (; n < out.near && out.pairs[n].pole == i; ++n) {
    const Eigen::Index j = out.pairs[n].coil;
    const Eigen::Vector3d& cross = out.pairs[n].cross;
    const TorqueCurve::Safe& safe = out.pairs[n].curve;
    const Eigen::Vector3d s = coils_.col(j);
    const Eigen::Vector3d torque = safe.h * cross;
    out.d_coil.col(j) += weight_(i, j) * torque;
    const double weight = current[j] * weight_(i, j);
    const Eigen::Vector3d steep = (weight * safe.dh) * cross;
    const Eigen::Vector3d pulled = (weight * safe.h) * r;
    slope += steep * s.transpose();
    along += (weight * safe.h) * s;
    const Eigen::Matrix<double, 3, 2>& d_coil = d_coil_[static_cast<std::size_t>(j)];
    for (Eigen::Index c = 0; c < 2; ++c) {
      const Eigen::Vector3d moved = d_coil.col(c);
      out.d_x.col(space_->coil(static_cast<std::size_t>(j)) + c) +=
          r.dot(moved) * steep + pulled.cross(moved);
    }
    addEffects(pole, static_cast<std::size_t>(j), weight, r, torque, out);
  }
  const Eigen::Matrix3d d_pole = slope - skew(along);
  // Only the pole turns with the rotor: r → r + ξ × r.
  out.d_turn -= d_pole * skew(r);
  out.d_x.middleCols<2>(space_->pole(pole)) = d_pole * (R * d_pole_[pole]);
  return n;
}

void MotionPoint::addLoads(const Eigen::Matrix3d& R, StatorTorque& out) const {
  const Eigen::Matrix3d R_rotor_stator = R.transpose();
  for (const auto& [placed, values] : loads_) {
    Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, placed->size());
    placed->effect->addLoadColumns(R_rotor_stator, columns);
    const Eigen::Matrix3Xd turned = R.lazyProduct(columns);
    const Eigen::Vector3d load = turned * values;
    out.torque += load;
    out.d_turn += R * placed->effect->loadRotation(values, R_rotor_stator) - skew(load);
    out.d_x.middleCols(space_->effect() + placed->first, placed->size()) +=
        placed->effect->scale() * turned;
  }
}

void MotionPoint::torque(const Eigen::Matrix3d& R_stator_rotor,
                         const Eigen::VectorXd& current,
                         StatorTorque& out) const {
  out.d_turn.setZero();
  out.d_x.setZero(3, space_->size());
  out.d_coil.setZero(3, coils_.cols());
  findPairs(R_stator_rotor, out);
  for (std::size_t n = 0; n < out.near;) {
    n = addPole(n, R_stator_rotor, current, out);
  }
  out.torque = out.d_coil * current;
  addLoads(R_stator_rotor, out);
}

}  // namespace sac
