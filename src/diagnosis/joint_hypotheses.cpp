#include <cmath>
#include <utility>

#include "explanation_words.hpp"
#include "material_value.hpp"
#include "orientation_hypotheses.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

Hypothesis sign(std::size_t joint, const std::string& name) {
  Hypothesis result;
  result.cause = "joint_sign:" + numberText(joint);
  result.family = "joint_scale:" + numberText(joint);
  result.correct = [joint](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    for (Sample& sample : wiring.samples) {
      sample.joint_position[static_cast<Eigen::Index>(joint)] *= -1.0;
    }
  };
  result.redescribe = [joint](Actuator& actuator, const Eigen::VectorXd& /*values*/) {
    actuator.joints[joint].axis *= -1.0;
    actuator.joints[joint].offset *= -1.0;
  };
  result.sentence = [name](const Eigen::VectorXd& /*values*/) {
    return "the joint " + name +
           " counts the wrong way: change its `sign` in the joint sensor's file "
           "(joint_sensor.yaml), or turn its `axis` around in the description.";
  };
  return result;
}

Hypothesis swap(std::size_t first, std::size_t second, const Actuator& actuator) {
  Hypothesis result;
  result.cause = "joint_swap:" + numberText(first) + ":" + numberText(second);
  result.family = result.cause;
  result.correct = [first, second](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    for (Sample& sample : wiring.samples) {
      std::swap(sample.joint_position[static_cast<Eigen::Index>(first)],
                sample.joint_position[static_cast<Eigen::Index>(second)]);
      std::swap(sample.joint_stddev[static_cast<Eigen::Index>(first)],
                sample.joint_stddev[static_cast<Eigen::Index>(second)]);
      std::swap(sample.joint_shared_stddev[static_cast<Eigen::Index>(first)],
                sample.joint_shared_stddev[static_cast<Eigen::Index>(second)]);
    }
  };
  result.redescribe = [first, second](Actuator& described, const Eigen::VectorXd& /*values*/) {
    std::swap(described.joints[first].name, described.joints[second].name);
  };
  const std::string names = actuator.joints[first].name + " and " + actuator.joints[second].name;
  result.sentence = [names](const Eigen::VectorXd& /*values*/) {
    return "the readings of " + names +
           " are exchanged: exchange their registers in the joint sensor's file "
           "(joint_sensor.yaml), or their names in the description.";
  };
  return result;
}

Hypothesis unit(double factor, const std::string& words) {
  Hypothesis result;
  result.cause = "joint_degrees";
  result.family = result.cause;
  result.correct = [factor](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    for (Sample& sample : wiring.samples) {
      sample.joint_position *= factor;
      sample.joint_stddev *= factor;
      sample.joint_shared_stddev *= factor;
    }
  };
  result.sentence = [words, factor](const Eigen::VectorXd& /*values*/) {
    return words + format(
                       ": multiply every `scale` in the joint sensor's file "
                       "(joint_sensor.yaml) by %.6g, or convert the recording.",
                       factor);
  };
  return result;
}

Hypothesis scale(std::size_t joint, const std::string& name, double tolerance) {
  Hypothesis result;
  result.cause = "joint_scale:" + numberText(joint);
  result.family = result.cause;
  result.start = Eigen::VectorXd::Ones(1);
  result.correct = [joint](WiringCase& wiring, const Eigen::VectorXd& values) {
    for (Sample& sample : wiring.samples) {
      sample.joint_position[static_cast<Eigen::Index>(joint)] *= values[0];
      sample.joint_stddev[static_cast<Eigen::Index>(joint)] *= std::abs(values[0]);
      sample.joint_shared_stddev[static_cast<Eigen::Index>(joint)] *= std::abs(values[0]);
    }
  };
  result.is_material = [tolerance](const Eigen::VectorXd& values) {
    return std::abs(values[0] - 1.0) > tolerance;
  };
  result.sentence = [name](const Eigen::VectorXd& values) {
    return "the joint " + name +
           format(
               " turns %.6g times as far as it reads: multiply its `scale` in the joint "
               "sensor's file (joint_sensor.yaml) by %.6g; check counts_per_turn and "
               "gear ratio.",
               values[0],
               values[0]);
  };
  return result;
}

Hypothesis index(std::size_t joint, const std::string& name, double tolerance) {
  Hypothesis result;
  result.cause = "joint_index:" + numberText(joint);
  result.family = result.cause;
  result.start = Eigen::VectorXd::Zero(1);
  result.correct = [joint](WiringCase& wiring, const Eigen::VectorXd& values) {
    for (Sample& sample : wiring.samples) {
      sample.joint_position[static_cast<Eigen::Index>(joint)] += values[0];
    }
  };
  result.redescribe = [joint](Actuator& actuator, const Eigen::VectorXd& values) {
    actuator.joints[joint].offset += std::remainder(values[0], 2.0 * kPi);
  };
  result.is_material = [tolerance](const Eigen::VectorXd& values) {
    return std::abs(values[0]) > kMaterial * tolerance;
  };
  result.sentence = [name](const Eigen::VectorXd& values) {
    const double angle = std::remainder(values[0], 2.0 * kPi);
    return "the joint " + name +
           format(
               " reads %.4g rad (%.4g deg) less than its angle: set its `zero` in the "
               "joint sensor's file (joint_sensor.yaml) at the index mark again, or "
               "add %.6g to its `offset` in the description.",
               angle,
               angle / kOneDegree,
               angle);
  };
  return result;
}

}  // namespace

std::vector<Hypothesis> jointHypotheses(const Actuator& actuator,
                                        const ManufacturingTolerance& tolerance) {
  std::vector<Hypothesis> all;
  if (!actuator.has_joints) {
    return all;
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    all.push_back(sign(k, actuator.joints[k].name));
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    for (std::size_t l = k + 1; l < kJoints; ++l) {
      all.push_back(swap(k, l, actuator));
    }
  }
  all.push_back(unit(kOneDegree, "the joint angles are degrees, not radians"));
  all.push_back(unit(1.0 / kOneDegree, "the joint angles were converted to radians twice"));
  for (std::size_t k = 0; k < kJoints; ++k) {
    all.push_back(scale(k, actuator.joints[k].name, tolerance.joint_offset));
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    all.push_back(index(k, actuator.joints[k].name, tolerance.joint_offset));
  }
  return all;
}

}  // namespace sac
