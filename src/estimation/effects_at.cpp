#include "effects_at.hpp"

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

using Columns = LaboratoryEffect::Columns;

/// Readings of joints [rad] that have nothing special, nor has the rotor there: what is zero here
/// is zero everywhere.
Eigen::Vector3d anywhere() {
  return {0.31, -0.23, 0.57};
}

}  // namespace

EffectsAt::EffectsAt(const ParameterSpace& space, const Eigen::VectorXd& x)
    : space_(space), values_(x.tail(space.effects().size())) {
  for (const PlacedEffect& placed : space.effects().effects()) {
    values_.segment(placed.first, placed.size()) *= placed.effect->scale();
    if (space.coils() > 0 &&
        placed.effect->strengthCoordinate(space.poles() - 1, space.coils() - 1) >= 0) {
      on_strength_.push_back(&placed);
    }
  }
  on_readings_ = actingBy([](const LaboratoryEffect& effect, Columns columns) {
    effect.addReadingColumns(anywhere(), columns);
  });
  on_tracker_ = actingBy(
      [](const LaboratoryEffect& effect, Columns columns) { effect.addTrackerColumns(columns); });
  on_marker_ = actingBy(
      [](const LaboratoryEffect& effect, Columns columns) { effect.addMarkerColumns(columns); });
  on_torque_frame_ = actingBy([](const LaboratoryEffect& effect, Columns columns) {
    effect.addTorqueFrameColumns(columns);
  });
  on_load_ = actingBy([](const LaboratoryEffect& effect, Columns columns) {
    effect.addLoadColumns(rotationExp(anywhere()), columns);
  });
  on_curve_ = actingBy([](const LaboratoryEffect& effect, Columns columns) {
    columns.setConstant(effect.changesCurve() ? 1.0 : 0.0);
  });
}

template <typename AddColumns>
ActingEffects EffectsAt::actingBy(const AddColumns& add_columns) const {
  ActingEffects acting;
  Eigen::Index size = 0;
  for (const PlacedEffect& placed : space_.effects().effects()) {
    Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, placed.size());
    add_columns(*placed.effect, columns);
    if (!columns.isZero(0.0)) {
      acting.parts.push_back({&placed, size});
      size += placed.size();
    }
  }
  acting.values.resize(size);
  for (const ActingEffects::Part& part : acting.parts) {
    acting.values.segment(part.first, part.placed->size()) =
        values_.segment(part.placed->first, part.placed->size());
  }
  return acting;
}

template <typename AddColumns>
Eigen::Matrix3Xd EffectsAt::collect(const ActingEffects& acting, const AddColumns& add_columns) {
  Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, acting.size());
  for (const ActingEffects::Part& part : acting.parts) {
    add_columns(*part.placed->effect, columns.middleCols(part.first, part.placed->size()));
  }
  return columns;
}

Eigen::Matrix3Xd EffectsAt::readingColumns(const Eigen::Vector3d& reading) const {
  return collect(on_readings_, [&](const LaboratoryEffect& effect, Columns columns) {
    effect.addReadingColumns(reading, columns);
  });
}

Eigen::Matrix3Xd EffectsAt::trackerColumns() const {
  return collect(on_tracker_, [](const LaboratoryEffect& effect, Columns columns) {
    effect.addTrackerColumns(columns);
  });
}

Eigen::Matrix3Xd EffectsAt::markerColumns() const {
  return collect(on_marker_, [](const LaboratoryEffect& effect, Columns columns) {
    effect.addMarkerColumns(columns);
  });
}

Eigen::Matrix3Xd EffectsAt::torqueFrameColumns() const {
  return collect(on_torque_frame_, [](const LaboratoryEffect& effect, Columns columns) {
    effect.addTorqueFrameColumns(columns);
  });
}

Eigen::Matrix3Xd EffectsAt::loadColumns(const Eigen::Matrix3d& R_rotor_stator) const {
  return collect(on_load_, [&](const LaboratoryEffect& effect, Columns columns) {
    effect.addLoadColumns(R_rotor_stator, columns);
  });
}

Eigen::Matrix3d EffectsAt::loadRotation(const Eigen::Matrix3d& R_rotor_stator) const {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  for (const ActingEffects::Part& part : on_load_.parts) {
    rotation += part.placed->effect->loadRotation(
        on_load_.values.segment(part.first, part.placed->size()), R_rotor_stator);
  }
  return rotation;
}

double EffectsAt::strength(std::size_t pole, std::size_t coil) const {
  double strength = 1.0;
  for (const PlacedEffect* const placed : on_strength_) {
    const Eigen::Index n = placed->effect->strengthCoordinate(pole, coil);
    strength *= n < 0 ? 1.0 : 1.0 + values_[placed->first + n];
  }
  return strength;
}

void EffectsAt::subtractStrengthColumns(std::size_t pole,
                                        std::size_t coil,
                                        const Eigen::Vector3d& torque,
                                        ResidualJacobian& jacobian) const {
  forEachStrength(pole, coil, [&](Eigen::Index coordinate, double factor) {
    jacobian.col(coordinate) -= factor * torque;
  });
}

void EffectsAt::addPairColumns(const Eigen::Vector3d& pole_rotor,
                               const Eigen::Vector3d& coil_rotor,
                               double weight,
                               Eigen::Matrix3Xd& columns) const {
  for (const ActingEffects::Part& part : on_curve_.parts) {
    Eigen::Matrix3Xd own = Eigen::Matrix3Xd::Zero(3, part.placed->size());
    part.placed->effect->addPairColumns(pole_rotor, coil_rotor, own);
    columns.middleCols(part.first, part.placed->size()) += weight * own;
  }
}

std::optional<TorqueCurve> EffectsAt::changedCurve() const {
  std::optional<TorqueCurve> curve;
  for (const ActingEffects::Part& part : on_curve_.parts) {
    // Nothing but the curve, for that is done at every evaluation.
    Actuator bare;
    bare.torque_curve = curve ? curve->description() : *space_.nominal().torque_curve;
    part.placed->effect->applyTo(bare, on_curve_.values.segment(part.first, part.placed->size()));
    curve.emplace(*bare.torque_curve);
  }
  return curve;
}

void EffectsAt::add(const ActingEffects& acting,
                    const Eigen::Matrix3d& left,
                    const Eigen::Matrix3Xd& columns,
                    ResidualJacobian& jacobian) const {
  for (const ActingEffects::Part& part : acting.parts) {
    const Eigen::Matrix3d scaled = part.placed->effect->scale() * left;
    const Eigen::Index first = space_.effect() + part.placed->first;
    for (Eigen::Index n = 0; n < part.placed->size(); ++n) {
      jacobian.col(first + n) += scaled * columns.col(part.first + n);
    }
  }
}

}  // namespace sac
