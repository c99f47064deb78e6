#include "motion_dynamics.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"

namespace sac {
namespace {

/// What a motion told of a parameter; nothing where it did not.
std::optional<double> told(const CycleReport& report, const std::string& name) {
  for (const ParameterEstimate& estimate : report.estimates) {
    if (estimate.name == name && estimate.observable) {
      return estimate.value;
    }
  }
  return std::nullopt;
}

/// Of a reference that was held, the nominal value.
std::optional<double> toldOrHeld(const CycleReport& report, const std::string& name) {
  const std::optional<double> value = told(report, name);
  if (value || name != "rotor_inertia/zz") {
    return value;
  }
  return RigidRotor().inertia(2, 2);
}

}  // namespace

void takeDynamics(const std::vector<CycleReport>& reports, Actuator& actuator) {
  const auto motion = std::find_if(reports.rbegin(), reports.rend(), [](const CycleReport& report) {
    return report.cycle == Cycle::kMotion && report.success;
  });
  if (motion == reports.rend()) {
    return;
  }
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  bool is_told = true;
  constexpr char kAxes[] = "xyz";
  for (Eigen::Index a = 0; a < 3; ++a) {
    for (Eigen::Index b = a; b < 3; ++b) {
      const std::string name = std::string("rotor_inertia/") + kAxes[a] + kAxes[b];
      const std::optional<double> value = toldOrHeld(*motion, name);
      is_told = is_told && value;
      inertia(a, b) = inertia(b, a) = value.value_or(0.0);
    }
  }
  if (is_told) {
    actuator.inertia = inertia;
  }
  const std::optional<double> viscous = told(*motion, "viscous_friction");
  const std::optional<double> coulomb = told(*motion, "coulomb_friction");
  if (viscous && coulomb) {
    actuator.friction = {*viscous, *coulomb};
  }
  Eigen::Vector3d unbalance;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const std::optional<double> value = told(*motion, std::string("rotor_unbalance/") + kAxes[a]);
    if (!value) {
      return;
    }
    unbalance[a] = *value;
  }
  actuator.unbalance = unbalance;
}

}  // namespace sac
