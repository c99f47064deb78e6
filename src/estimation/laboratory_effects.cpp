#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"

#include <algorithm>

#include "effects/registered_effects.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

/// What is known of an effect before it is modelled for an actuator.
struct EffectKind {
  const char* name;
  const char* unit;
  LaboratoryEffect::ActsOn acts_on;
  LaboratoryEffect::BelongsTo belongs_to;
  std::shared_ptr<const LaboratoryEffect> (*make)(const Actuator&, const EffectSelection&);
};

template <typename Effect>
EffectKind kindOf() {
  return {Effect::kName,
          Effect::kUnit,
          Effect::kActsOn,
          Effect::kBelongsTo,
          [](const Actuator& nominal,
             const EffectSelection& selection) -> std::shared_ptr<const LaboratoryEffect> {
            return std::make_shared<Effect>(nominal, selection);
          }};
}

template <typename... Effects>
std::vector<EffectKind> kindsOf(const std::tuple<Effects...>* /*list*/) {
  return {kindOf<Effects>()...};
}

/// Whether the description states an uncertainty of what the effect changes.
bool isStatedBy(const Actuator& nominal, const EffectKind& kind) {
  return std::string(kind.name) == effects::TorqueCurveChange::kName && nominal.torque_curve &&
         relativeTableStddev(nominal.torque_curve->table) > 0.0;
}

/// Without joints the tracker's orientation is no observation: torques feel what is wrong with it.
LaboratoryEffect::ActsOn actsOn(const EffectKind& kind, const Actuator& nominal) {
  const bool is_of_reading =
      !nominal.has_joints && kind.acts_on == LaboratoryEffect::ActsOn::kOrientations;
  return is_of_reading ? LaboratoryEffect::ActsOn::kTorques : kind.acts_on;
}

bool needsTorques(const EffectKind& kind, const Actuator& nominal) {
  const LaboratoryEffect::ActsOn acts_on = actsOn(kind, nominal);
  return acts_on == LaboratoryEffect::ActsOn::kTorques ||
         acts_on == LaboratoryEffect::ActsOn::kMotion;
}

/// What acts on everything does so by the readings of joints.
bool needsJoints(const EffectKind& kind) {
  return kind.acts_on == LaboratoryEffect::ActsOn::kEverything;
}

const std::vector<EffectKind>& kinds() {
  static const std::vector<EffectKind> kinds =
      kindsOf(static_cast<const effects::Registered*>(nullptr));
  return kinds;
}

const EffectKind& kindOf(const std::string& effect) {
  const auto kind = std::find_if(
      kinds().begin(), kinds().end(), [&](const EffectKind& each) { return each.name == effect; });
  if (kind == kinds().end()) {
    throw ConfigError("effects." + effect + ": there is no such laboratory effect.");
  }
  return *kind;
}

}  // namespace

const std::vector<std::string>& effectNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const EffectKind& kind : kinds()) {
      // What only motion tells belongs to its cycle, and is no option.
      if (kind.acts_on != LaboratoryEffect::ActsOn::kMotion) {
        result.emplace_back(kind.name);
      }
    }
    return result;
  }();
  return names;
}

EffectSelection withMotionEffects(EffectSelection selection) {
  for (const EffectKind& kind : kinds()) {
    if (kind.acts_on == LaboratoryEffect::ActsOn::kMotion) {
      selection[kind.name] = true;
    }
  }
  selection[effects::RotorUnbalance::kName] = true;
  selection[effects::RotorInertia::kName] = !selection.has(effects::StrengthScale::kName);
  return selection;
}

bool isToldByMotion(const std::string& effect) {
  const EffectKind& kind = kindOf(effect);
  const bool is_of_rotor = kind.belongs_to == LaboratoryEffect::BelongsTo::kActuator ||
                           kind.belongs_to == LaboratoryEffect::BelongsTo::kLoad;
  return is_of_rotor && effect != effects::StrengthScale::kName;
}

std::vector<std::string> modelledEffects(const EffectSelection& selection) {
  std::vector<std::string> names;
  for (const EffectKind& kind : kinds()) {
    if (selection.has(kind.name)) {
      names.emplace_back(kind.name);
    }
  }
  return names;
}

bool canHaveEffect(const Actuator& actuator, const std::string& effect) {
  const EffectKind& kind = kindOf(effect);
  return (actuator.has_joints || !needsJoints(kind)) &&
         (actuator.hasTorqueModel() || !needsTorques(kind, actuator));
}

std::string describe(const EffectSelection& selection) {
  std::string names;
  for (const std::string& name : modelledEffects(selection)) {
    names += (names.empty() ? "" : ", ") + name;
    if (name == effects::EncoderHarmonics::kName && selection.harmonicJoints().size() < kJoints) {
      for (const std::size_t joint : selection.harmonicJoints()) {
        names += " joint_" + std::to_string(numberOf(joint));
      }
    }
  }
  return names.empty() ? "none" : names;
}

EffectLayout::EffectLayout(const Actuator& nominal, const EffectSelection& selection) {
  for (const auto& entry : selection.all()) {
    kindOf(entry.first);
  }
  for (const auto& entry : selection.stddevs()) {
    kindOf(entry.first);
  }
  for (const EffectKind& kind : kinds()) {
    if (!selection.has(kind.name) && !isStatedBy(nominal, kind)) {
      continue;
    }
    if (needsTorques(kind, nominal) && !nominal.hasTorqueModel()) {
      if (!selection[kind.name]) {
        continue;  // stated for all, but nothing here feels it
      }
      throw ConfigError(std::string("effects.") + kind.name +
                        ": the description has no poles, coils or torque curve.");
    }
    if (needsJoints(kind) && !nominal.has_joints) {
      throw ConfigError(std::string("effects.") + kind.name + ": the description has no joints.");
    }
    const std::shared_ptr<const LaboratoryEffect> effect = kind.make(nominal, selection);
    const double stated = selection.stddev(kind.name);
    effects_.push_back({kind.name,
                        kind.unit,
                        actsOn(kind, nominal),
                        kind.belongs_to,
                        size_,
                        effect,
                        stated > 0.0 ? stated : effect->priorStddev()});
    size_ += effects_.back().size();
  }
  stated_covariance_ = Eigen::MatrixXd::Zero(size_, size_);
  for (const PlacedEffect& placed : effects_) {
    const double stddev = placed.stddev / placed.effect->scale();
    stated_covariance_.diagonal().segment(placed.first, placed.size()).setConstant(stddev * stddev);
  }
  for (const StatedTogether& stated : selection.together()) {
    stateTogether(stated);
  }
}

/// Of those of the effects that are modelled here.
void EffectLayout::stateTogether(const StatedTogether& stated) {
  if (stated.effects.empty()) {
    return;
  }
  const Eigen::Index size =
      stated.covariance.rows() / static_cast<Eigen::Index>(stated.effects.size());
  const auto of = [&](const PlacedEffect& placed) {
    return std::find(stated.effects.begin(), stated.effects.end(), placed.name) -
           stated.effects.begin();
  };
  const auto several = static_cast<Eigen::Index>(stated.effects.size());
  for (const PlacedEffect& a : effects_) {
    for (const PlacedEffect& b : effects_) {
      if (of(a) < several && of(b) < several) {
        stated_covariance_.block(a.first, b.first, size, size) =
            stated.covariance.block(size * of(a), size * of(b), size, size) /
            (a.effect->scale() * b.effect->scale());
      }
    }
  }
}

Eigen::Index EffectLayout::first(const std::string& effect) const {
  for (const PlacedEffect& placed : effects_) {
    if (placed.name == effect) {
      return placed.first;
    }
  }
  throw DataError("The laboratory effect " + effect + " is not modelled.");
}

const PlacedEffect& EffectLayout::at(Eigen::Index coordinate) const {
  for (const PlacedEffect& placed : effects_) {
    if (coordinate >= placed.first && coordinate < placed.first + placed.size()) {
      return placed;
    }
  }
  throw DataError("Effect coordinate " + std::to_string(coordinate) + " does not exist.");
}

double EffectLayout::statedVariance(Eigen::Index coordinate) const {
  at(coordinate);  // there is one
  return stated_covariance_(coordinate, coordinate);
}

double EffectLayout::nominalValue(Eigen::Index coordinate) const {
  const PlacedEffect& placed = at(coordinate);
  return placed.effect->nominalValue(coordinate - placed.first);
}

const std::string& EffectLayout::name(Eigen::Index coordinate) const {
  const PlacedEffect& placed = at(coordinate);
  return placed.effect->names()[static_cast<std::size_t>(coordinate - placed.first)];
}

Eigen::VectorXd EffectLayout::values(const PlacedEffect& placed, const double* coordinates) {
  return placed.effect->scale() *
         Eigen::Map<const Eigen::VectorXd>(coordinates + placed.first, placed.size());
}

}  // namespace sac
