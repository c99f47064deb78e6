#include "torque_hypotheses.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "cube_rotations.hpp"
#include "material_value.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

constexpr double kAlike = 0.08;  // of factors: the same unit

/// `change`: what becomes of one sample with torque.
template <typename Change>
Hypothesis ofTorques(const std::string& cause, const std::string& sentence, Change change) {
  Hypothesis result;
  result.cause = cause;
  result.family = cause;
  result.correct = [change](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    for (Sample& sample : wiring.samples) {
      if (sample.has_torque) {
        change(wiring.actuator, sample);
      }
    }
  };
  result.sentence = [sentence](const Eigen::VectorXd& /*values*/) { return sentence; };
  return result;
}

std::string torqueFrameSentence(const Eigen::Matrix3d& rotation) {
  return "the measured torques are in a frame that is turned by " +
         rotationInWords(rotation.transpose()) +
         " from the rotor: turn the launch argument rotor_ft_sensor (registration of the "
         "force/torque sensor) by " +
         rotationInWords(rotation) + " in the rotor frame.";
}

struct Unit {
  double factor;
  const char* name;
};

/// What an opposite sign of all torques and one of all currents looks like in a description.
void turnPolarities(Actuator& actuator, const Eigen::VectorXd& /*values*/) {
  for (PoleAxis& pole : actuator.poles) {
    pole.polarity *= -1;
  }
}

/// The unit that a factor to N·m belongs to, else the factor itself.
std::string torqueUnitName(double factor) {
  constexpr std::array<Unit, 7> kUnits = {{{1e-3, "N mm"},
                                           {1e-2, "N cm"},
                                           {9.80665e-2, "kgf cm"},
                                           {9.80665, "kgf m"},
                                           {0.1129848, "lbf in"},
                                           {1.355818, "lbf ft"},
                                           {7.061552e-3, "ozf in"}}};
  for (const Unit& unit : kUnits) {
    if (std::abs(factor / unit.factor - 1.0) < kAlike) {
      return format("%s, not N m", unit.name);
    }
  }
  return format("%.3g times what the coils exert", 1.0 / factor);
}

}  // namespace

Eigen::Matrix3d knownOrientation(const Actuator& actuator, const Sample& sample) {
  return sample.has_orientation ? sample.R_stator_rotor
                                : rotorOrientation(jointGeometry(actuator), sample.joint_position);
}

Hypothesis torqueFrame(const Eigen::Matrix3d& rotation) {
  return ofTorques("torque_frame",
                   torqueFrameSentence(rotation),
                   [rotation](const Actuator& /*actuator*/, Sample& sample) {
                     sample.torque = rotation * sample.torque;
                   });
}

Hypothesis torqueRotation(const Eigen::Vector3d& rotation_vector, double tolerance) {
  Hypothesis result;
  result.cause = "torque_frame";
  result.family = result.cause;
  result.start = rotation_vector;
  result.correct = [](WiringCase& wiring, const Eigen::VectorXd& values) {
    const Eigen::Matrix3d rotation = rotationExp(values.head<3>());
    for (Sample& sample : wiring.samples) {
      sample.torque = rotation * sample.torque;
    }
  };
  result.is_material = [tolerance](const Eigen::VectorXd& values) {
    return values.norm() > kMaterial * tolerance;
  };
  result.sentence = [](const Eigen::VectorXd& values) {
    return torqueFrameSentence(rotationExp(values.head<3>()));
  };
  return result;
}

Hypothesis torqueInStatorFrame() {
  return ofTorques("torque_in_stator_frame",
                   "the measured torques are expressed in the stator, not in the rotor: a sensor "
                   "under the stator is registered by the launch argument stator_ft_sensor, not "
                   "rotor_ft_sensor; other sources must turn their torques into the rotor.",
                   [](const Actuator& actuator, Sample& sample) {
                     sample.torque = knownOrientation(actuator, sample).transpose() * sample.torque;
                   });
}

Hypothesis torqueSign() {
  Hypothesis result =
      ofTorques("torque_sign",
                "the measured torques have the opposite sign, that of the reaction on the "
                "stator: set ft_sensor_mount in tracker_bridge.yaml to where the sensor is "
                "fixed, or change the sign where torques are published. All currents, or all "
                "polarities, with the opposite sign look the same.",
                [](const Actuator& /*actuator*/, Sample& sample) { sample.torque *= -1.0; });
  result.redescribe = turnPolarities;
  return result;
}

Hypothesis currentSign() {
  Hypothesis result =
      ofTorques("current_sign",
                "all coil currents have the opposite sign: make `scale` of setpoints and "
                "currents negative in the coil driver's file (coil_driver.yaml), or exchange "
                "the leads. All torques, or all polarities, with the opposite sign look the "
                "same.",
                [](const Actuator& /*actuator*/, Sample& sample) { sample.current *= -1.0; });
  result.redescribe = turnPolarities;
  return result;
}

Hypothesis torqueUnit(double first_guess, double tolerance) {
  Hypothesis result;
  result.cause = "torque_unit";
  result.family = result.cause;
  result.start = Eigen::VectorXd::Constant(1, std::log(first_guess));
  result.correct = [](WiringCase& wiring, const Eigen::VectorXd& values) {
    for (Sample& sample : wiring.samples) {
      sample.torque *= std::exp(values[0]);
      sample.torque_stddev *= std::exp(values[0]);
    }
  };
  result.torque_factor = [](const Eigen::VectorXd& values) { return std::exp(values[0]); };
  result.is_material = [tolerance](const Eigen::VectorXd& values) {
    return std::abs(values[0]) > kMaterial * tolerance;
  };
  result.sentence = [](const Eigen::VectorXd& values) {
    const double factor = std::exp(values[0]);
    return "the measured torques are " + torqueUnitName(factor) +
           format(
               ": multiply them by %.4g where they are published (force/torque sensor's "
               "driver).",
               factor);
  };
  return result;
}

Hypothesis currentUnit(double first_guess, double tolerance) {
  Hypothesis result = torqueUnit(first_guess, tolerance);
  result.cause = "current_unit";
  result.family = result.cause;
  result.torque_factor = nullptr;
  result.correct = [](WiringCase& wiring, const Eigen::VectorXd& values) {
    for (Sample& sample : wiring.samples) {
      sample.current *= std::exp(values[0]);
    }
  };
  result.sentence = [](const Eigen::VectorXd& values) {
    const double factor = std::exp(values[0]);
    const std::string what =
        std::abs(factor * 1e3 - 1.0) < kAlike
            ? "the coil currents are milliamperes, not amperes"
            : format("the coil currents are %.3g times what the torques need", 1.0 / factor);
    return what + format(
                      ": multiply `scale` of setpoints and currents in the coil driver's file "
                      "(coil_driver.yaml) by %.4g.",
                      factor);
  };
  return result;
}

}  // namespace sac
