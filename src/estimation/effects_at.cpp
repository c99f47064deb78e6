#include "effects_at.hpp"

namespace sac {

EffectsAt::EffectsAt(const ParameterSpace& space, const Eigen::VectorXd& x)
    : space_(space), values_(x.tail(space.effects().size())) {
  for (const PlacedEffect& placed : space.effects().effects()) {
    values_.segment(placed.first, placed.size()) *= placed.effect->scale();
  }
}

template <typename Add>
Eigen::Matrix3Xd EffectsAt::collect(const Add& add) const {
  Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, values_.size());
  for (const PlacedEffect& placed : space_.effects().effects()) {
    add(*placed.effect, columns.middleCols(placed.first, placed.size()));
  }
  return columns;
}

Eigen::Matrix3Xd EffectsAt::readingColumns(const Eigen::Vector3d& reading) const {
  return collect([&](const LaboratoryEffect& effect, LaboratoryEffect::Columns columns) {
    effect.addReadingColumns(reading, columns);
  });
}

Eigen::Matrix3Xd EffectsAt::trackerColumns() const {
  return collect([](const LaboratoryEffect& effect, LaboratoryEffect::Columns columns) {
    effect.addTrackerColumns(columns);
  });
}

Eigen::Matrix3Xd EffectsAt::markerColumns() const {
  return collect([](const LaboratoryEffect& effect, LaboratoryEffect::Columns columns) {
    effect.addMarkerColumns(columns);
  });
}

Eigen::Matrix3Xd EffectsAt::torqueFrameColumns() const {
  return collect([](const LaboratoryEffect& effect, LaboratoryEffect::Columns columns) {
    effect.addTorqueFrameColumns(columns);
  });
}

Eigen::Matrix3Xd EffectsAt::loadColumns(const Eigen::Matrix3d& R_rotor_stator) const {
  return collect([&](const LaboratoryEffect& effect, LaboratoryEffect::Columns columns) {
    effect.addLoadColumns(R_rotor_stator, columns);
  });
}

Eigen::Matrix3d EffectsAt::loadRotation(const Eigen::Matrix3d& R_rotor_stator) const {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  for (const PlacedEffect& placed : space_.effects().effects()) {
    rotation +=
        placed.effect->loadRotation(values_.segment(placed.first, placed.size()), R_rotor_stator);
  }
  return rotation;
}

double EffectsAt::strength(std::size_t pole, std::size_t coil) const {
  double strength = 1.0;
  for (const PlacedEffect& placed : space_.effects().effects()) {
    const Eigen::Index n = placed.effect->strengthCoordinate(pole, coil);
    strength *= n < 0 ? 1.0 : 1.0 + values_[placed.first + n];
  }
  return strength;
}

void EffectsAt::subtractStrengthColumns(std::size_t pole,
                                        std::size_t coil,
                                        const Eigen::Vector3d& torque,
                                        Eigen::Matrix3Xd& columns) const {
  for (const PlacedEffect& placed : space_.effects().effects()) {
    const Eigen::Index n = placed.effect->strengthCoordinate(pole, coil);
    if (n >= 0) {
      columns.col(placed.first + n) -= torque / (1.0 + values_[placed.first + n]);
    }
  }
}

void EffectsAt::subtractPairColumns(const Eigen::Vector3d& pole_rotor,
                                    const Eigen::Vector3d& coil_rotor,
                                    double weight,
                                    Eigen::Matrix3Xd& columns) const {
  for (const PlacedEffect& placed : space_.effects().effects()) {
    if (placed.effect->changesCurve()) {
      Eigen::Matrix3Xd own = Eigen::Matrix3Xd::Zero(3, placed.size());
      placed.effect->addPairColumns(pole_rotor, coil_rotor, own);
      columns.middleCols(placed.first, placed.size()) -= weight * own;
    }
  }
}

std::optional<TorqueCurve> EffectsAt::changedCurve() const {
  std::optional<TorqueCurve> curve;
  for (const PlacedEffect& placed : space_.effects().effects()) {
    if (placed.effect->changesCurve()) {
      // Nothing but the curve, for that is done at every evaluation.
      Actuator bare;
      bare.torque_curve = curve ? curve->description() : *space_.nominal().torque_curve;
      placed.effect->applyTo(bare, values_.segment(placed.first, placed.size()));
      curve.emplace(*bare.torque_curve);
    }
  }
  return curve;
}

void EffectsAt::write(const Eigen::Matrix3Xd& columns, ResidualJacobian& jacobian) const {
  for (const PlacedEffect& placed : space_.effects().effects()) {
    jacobian.middleCols(space_.effect() + placed.first, placed.size()) =
        placed.effect->scale() * columns.middleCols(placed.first, placed.size());
  }
}

}  // namespace sac
