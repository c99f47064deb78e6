#include "spherical_actuator_calibration/actuator/actuator.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "torque_of_a_coil.hpp"

namespace sac {
namespace {

/// Key of an entry as a description file counts it, from 0: "poles[3]".
std::string entryKey(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

void validateJoints(const std::array<JointAxis, kJoints>& joints) {
  for (std::size_t k = 0; k < kJoints; ++k) {
    const std::string key = entryKey("joints", k);
    const JointAxis& joint = joints[k];
    requireInRange(key + ".axis: length",
                   joint.axis.norm(),
                   ValueRange::closed(1.0 - kUnitTolerance, 1.0 + kUnitTolerance));
    requireInRange(key + ".offset", joint.offset, ValueRange::finite("rad"));
    for (std::size_t other = 0; other < k; ++other) {
      if (joints[other].name == joint.name) {
        throw ConfigError(key + ".name: \"" + joint.name + "\" is also the name of " +
                          entryKey("joints", other) + "; each joint needs its own.");
      }
    }
  }
}

template <typename PoleOrCoil>
void validateAxis(const std::string& key, const PoleOrCoil& axis) {
  requireInRange(key + ".polar", axis.polar, ValueRange::closed(-kPi / 2.0, kPi / 2.0, "rad"));
  requireInRange(key + ".azimuth", axis.azimuth, ValueRange::finite("rad"));
  requireInRange(key + ".gain", axis.gain, ValueRange::positive());
}

void validateCorrection(const std::string& key, const ReadingCorrection& correction) {
  constexpr double kLargestLinear = 0.5;
  constexpr double kLargestHarmonic = 0.5;  // [rad]
  for (const double value : correction.linear) {
    requireInRange(key + ".linear", value, ValueRange::closed(-kLargestLinear, kLargestLinear));
  }
  for (const double value : correction.harmonics) {
    requireInRange(
        key + ".harmonics", value, ValueRange::closed(-kLargestHarmonic, kLargestHarmonic, "rad"));
  }
}

bool isPlain(const JointAxis& joint, const JointAxis& free) {
  return joint.axis == free.axis && joint.offset == free.offset &&
         joint.correction.linear == free.correction.linear &&
         joint.correction.harmonics == free.correction.harmonics;
}

void validateWithoutJoints(const Actuator& actuator) {
  const std::array<JointAxis, kJoints> free = freeRotorJoints();
  if (!std::equal(free.begin(), free.end(), actuator.joints.begin(), isPlain)) {
    throw ConfigError(
        "joints: the rotor has none, so that they have no axes, offsets or "
        "corrections either.");
  }
  if (actuator.orientation_map) {
    throw ConfigError("orientation_map: the rotor has no joints, over whose readings it could be.");
  }
}

/// Uncertain as it is, the inertia may be that of no body.
void validateDynamics(const Actuator& actuator) {
  if (!actuator.unbalance.allFinite()) {
    throw ConfigError("rotor_unbalance: it is not finite.");
  }
  if (actuator.inertia &&
      (!actuator.inertia->allFinite() || *actuator.inertia != actuator.inertia->transpose())) {
    throw ConfigError("rotor_inertia: it is not finite and symmetric.");
  }
  if (actuator.friction &&
      !(std::isfinite(actuator.friction->viscous) && std::isfinite(actuator.friction->coulomb))) {
    throw ConfigError("rotor_friction: it is not finite.");
  }
}

}  // namespace

std::array<JointAxis, kJoints> freeRotorJoints() {
  return {{{"rotation_x", Eigen::Vector3d::UnitX(), 0.0},
           {"rotation_y", Eigen::Vector3d::UnitY(), 0.0},
           {"rotation_z", Eigen::Vector3d::UnitZ(), 0.0}}};
}

std::size_t modelledCoils(const Actuator& actuator) {
  return actuator.hasTorqueModel() ? actuator.coils.size() : 0;
}

std::array<std::string, kJoints> jointNames(const Actuator& actuator) {
  return {actuator.joints[0].name, actuator.joints[1].name, actuator.joints[2].name};
}

void validate(const Actuator& actuator) {
  validateJoints(actuator.joints);
  if (!actuator.has_joints) {
    validateWithoutJoints(actuator);
  }
  for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
    const std::string key = entryKey("poles", i);
    validateAxis(key, actuator.poles[i]);
    if (std::abs(actuator.poles[i].polarity) != 1) {
      throw ConfigError(key + ".polarity: " + std::to_string(actuator.poles[i].polarity) +
                        " is neither 1 nor -1.");
    }
  }
  for (std::size_t j = 0; j < actuator.coils.size(); ++j) {
    validateAxis(entryKey("coils", j), actuator.coils[j]);
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    validateCorrection(entryKey("joints", k), actuator.joints[k].correction);
  }
  validateDynamics(actuator);
  if (actuator.torque_curve) {
    validate(*actuator.torque_curve);
    requireTorqueOfACoil(*actuator.torque_curve);
  }
  requireInRange("workspace.tilt_limit",
                 actuator.workspace.tilt_limit,
                 ValueRange::open(0.0, kPi / 2.0, "rad"));
}

Eigen::Vector3d axisFromAngles(double polar, double azimuth) {
  const double equatorial = std::cos(polar);
  return {equatorial * std::cos(azimuth), equatorial * std::sin(azimuth), std::sin(polar)};
}

AxisAngles anglesFromAxis(const Eigen::Vector3d& axis, double azimuth_hint) {
  // Below this share of the length the azimuth is made of rounding errors alone.
  constexpr double kEquatorialFloor = 1e-15;
  const double equatorial = std::hypot(axis.x(), axis.y());
  AxisAngles angles;
  angles.polar = std::atan2(axis.z(), equatorial);
  if (equatorial <= kEquatorialFloor * std::abs(axis.z())) {
    angles.azimuth = azimuth_hint;
    return angles;
  }
  const double azimuth = std::atan2(axis.y(), axis.x());
  const double turns = std::round((azimuth_hint - azimuth) / (2.0 * kPi));
  angles.azimuth = azimuth + 2.0 * kPi * turns;
  return angles;
}

void requireInWorkspace(const Eigen::Vector3d& q, const Workspace& workspace) {
  constexpr double kRounding = 1e-9;  // [rad]
  if (!q.allFinite() || !workspace.contains(q, kRounding)) {
    const double tilt = q.head<2>().cwiseAbs().maxCoeff();
    throw ConfigError("a tilt of " + shortNumber(tilt) +
                      " rad is beyond the workspace's tilt_limit of " +
                      shortNumber(workspace.tilt_limit) + " rad.");
  }
}

}  // namespace sac
