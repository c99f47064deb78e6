#include "motion_dynamics.hpp"

#include <algorithm>
#include <string>

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"

namespace sac {
namespace {

constexpr char kAxes[] = "xyz";

/// What a motion told of a parameter; null where it did not.
const ParameterEstimate* told(const CycleReport& report, const std::string& name) {
  for (const ParameterEstimate& estimate : report.estimates) {
    if (estimate.name == name && estimate.observable) {
      return &estimate;
    }
  }
  return nullptr;
}

std::optional<Eigen::Matrix3d> toldInertia(const CycleReport& report) {
  Eigen::Matrix3d inertia;
  for (Eigen::Index a = 0; a < 3; ++a) {
    for (Eigen::Index b = a; b < 3; ++b) {
      const std::string name =
          (std::string(effect_name::kRotorInertia) + "/") + kAxes[a] + kAxes[b];
      const ParameterEstimate* const moment = told(report, name);
      // A reference that is held has its nominal value.
      const bool is_reference = a == 2;
      if (moment == nullptr && !is_reference) {
        return std::nullopt;
      }
      const double value = moment != nullptr ? moment->value : RigidRotor().inertia(2, 2);
      inertia(a, b) = inertia(b, a) = value;
    }
  }
  return inertia;
}

}  // namespace

ToldDynamics toldDynamics(const std::vector<CycleReport>& reports) {
  const auto motion = std::find_if(reports.rbegin(), reports.rend(), [](const CycleReport& report) {
    return report.cycle == Cycle::kMotion && report.success;
  });
  if (motion == reports.rend()) {
    return {};
  }
  ToldDynamics dynamics;
  dynamics.inertia = toldInertia(*motion);
  const ParameterEstimate* const viscous = told(*motion, effect_name::kViscousFriction);
  const ParameterEstimate* const coulomb = told(*motion, effect_name::kCoulombFriction);
  if (viscous != nullptr && coulomb != nullptr) {
    dynamics.friction = {viscous->value, coulomb->value};
  }
  Eigen::Vector3d unbalance;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const ParameterEstimate* const moment =
        told(*motion, (std::string(effect_name::kRotorUnbalance) + "/") + kAxes[a]);
    if (moment == nullptr) {
      return dynamics;
    }
    unbalance[a] = moment->value;
    dynamics.unbalance_stddev[a] = moment->stddev;
  }
  dynamics.unbalance = unbalance;
  return dynamics;
}

std::string strangeInertiaInWords(const CycleReport& motion, const Actuator& described) {
  constexpr double kFar = 3.0;
  const std::optional<Eigen::Matrix3d> inertia = toldInertia(motion);
  if (!inertia) {
    return {};
  }
  const double factor = inertia->trace() / described.inertia.value_or(RigidRotor().inertia).trace();
  if (factor > 1.0 / kFar && factor < kFar) {
    return {};
  }
  return format(
      " The rotor's moments of inertia are %.3g times those of %s. A motion tells only their ratio "
      "to the torques: where the rotor is not that different, the torques of the recorded currents "
      "are %.3g times the real ones; check the unit of the currents, and the torque curve.",
      factor,
      described.inertia ? "the description" : "the rotor that a motion begins with",
      factor);
}

std::string exactInertiaInWords(const ParameterSpace& space) {
  const std::vector<PlacedEffect>& effects = space.effects().effects();
  const bool finds_strength =
      std::any_of(effects.begin(), effects.end(), [](const PlacedEffect& placed) {
        return placed.name == effect_name::kStrengthScale;
      });
  return finds_strength ? " Strength, unbalance and friction are relative to the inertia of the "
                          "drawing, which counts as exact: by how much it is off, they are, too."
                        : "";
}

}  // namespace sac
