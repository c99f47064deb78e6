#include "spherical_actuator_calibration/estimation/calibration_state.hpp"

#include <numeric>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"

namespace sac {
namespace {

void require(double value, const char* key) {
  if (!(value >= 0.0 && value <= 1.0)) {
    throw ConfigError(std::string("tolerance.") + key + ": " + std::to_string(value) +
                      " is outside [0, 1] rad.");
  }
}

}  // namespace

double toleranceOf(ParameterKind kind, const ManufacturingTolerance& tolerance) {
  switch (kind) {
    case ParameterKind::kJointOffset:
      return tolerance.joint_offset;
    case ParameterKind::kJointAxisU:
    case ParameterKind::kJointAxisV:
      return tolerance.joint_axis;
    case ParameterKind::kPolePolar:
    case ParameterKind::kPoleAzimuth:
      return tolerance.pole;
    case ParameterKind::kCoilPolar:
    case ParameterKind::kCoilAzimuth:
      return tolerance.coil;
    case ParameterKind::kEffect:
      break;
  }
  return tolerance.effect;
}

void validate(const ManufacturingTolerance& tolerance) {
  require(tolerance.joint_offset, "joint_offset");
  require(tolerance.joint_axis, "joint_axis");
  require(tolerance.pole, "pole");
  require(tolerance.coil, "coil");
  require(tolerance.effect, "effect");
}

CalibrationState nominalState(const ParameterSpace& space,
                              const ManufacturingTolerance& tolerance) {
  CalibrationState state;
  state.belief.x = Eigen::VectorXd::Zero(space.size());
  state.belief.covariance = Eigen::MatrixXd::Zero(space.size(), space.size());
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    const double stddev = toleranceOf(space.id(p).kind, tolerance);
    state.belief.covariance(p, p) = stddev * stddev;
  }
  std::vector<Eigen::Index> all(static_cast<std::size_t>(space.size()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  const std::vector<Eigen::Index> stated = statedOf(space, all);
  state.belief.covariance(stated, stated) = statedCovariance(space, stated);
  state.identified.assign(static_cast<std::size_t>(space.size()), false);
  return state;
}

}  // namespace sac
