#include "spherical_actuator_calibration/calibration/operator_advice.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/sample_coverage.hpp"

namespace sac {
namespace {

enum class Part { kJointOffset, kJointAxis, kPole, kCoil, kEffect };

Part partOf(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kJointOffset:
      return Part::kJointOffset;
    case ParameterKind::kJointAxisU:
    case ParameterKind::kJointAxisV:
      return Part::kJointAxis;
    case ParameterKind::kPolePolar:
    case ParameterKind::kPoleAzimuth:
      return Part::kPole;
    case ParameterKind::kCoilPolar:
    case ParameterKind::kCoilAzimuth:
      return Part::kCoil;
    case ParameterKind::kEffect:
      break;
  }
  return Part::kEffect;
}

/// Smaller eigenvalue of the information that one pair at this pose gives on one of its axes, for
/// unit current and noise: 0 when the pair does not interact.
double pairInformation(const TorqueCurve& curve,
                       const Eigen::Vector3d& pole_rotor,
                       const Eigen::Vector3d& coil_rotor,
                       Part part) {
  if (!interacts(curve, pole_rotor, coil_rotor)) {
    return 0.0;
  }
  const PairTorque pair = linearizePairTorque(curve, pole_rotor, coil_rotor);
  const Eigen::Vector3d axis = part == Part::kPole ? pole_rotor : coil_rotor;
  const AxisChart chart = AxisChart::aroundAxis(axis);
  const Eigen::Matrix<double, 3, 2> J =
      (part == Part::kPole ? pair.d_pole : pair.d_coil) * chart.jacobian(0.0, 0.0);
  const Eigen::Matrix2d N = J.transpose() * J;
  const double mean = 0.5 * N.trace();
  return mean - std::sqrt(std::max(0.0, mean * mean - N.determinant()));
}

/// Joint angles at which a coil tells most about a pole (or about itself, over all poles): upright
/// if that serves, tilted otherwise. Empty when no pose within the workspace does.
std::optional<Eigen::Vector3d> bestPose(const CalibrationModel& model,
                                        const Eigen::VectorXd& x,
                                        std::size_t coil,
                                        std::optional<std::size_t> pole) {
  constexpr int kSpinSteps = 120;
  const Actuator actuator = model.space().actuatorAt(x);
  const TorqueGeometry geometry = torqueGeometry(actuator);
  const JointGeometry joints = jointGeometry(actuator);
  const double tilt = actuator.workspace.tilt_limit;
  for (const double part_of_limit : {0.0, 0.5, 1.0}) {
    double best_information = 0.0;
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    const double t = tilt * part_of_limit;
    for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1.0, 0.0),
                                             Eigen::Vector2d(-1.0, 0.0),
                                             Eigen::Vector2d(0.0, 1.0),
                                             Eigen::Vector2d(0.0, -1.0)}) {
      for (int s = 0; s < kSpinSteps; ++s) {
        const Eigen::Vector3d q(
            t * direction[0], t * direction[1], kPi * (2.0 * s / kSpinSteps - 1.0));
        const Eigen::Vector3d coil_rotor =
            rotorOrientation(joints, q).transpose() *
            geometry.coils_stator.col(static_cast<Eigen::Index>(coil));
        for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
          if (pole && *pole != i) {
            continue;
          }
          const double information =
              pairInformation(model.curve(),
                              geometry.poles_rotor.col(static_cast<Eigen::Index>(i)),
                              coil_rotor,
                              pole ? Part::kPole : Part::kCoil);
          if (information > best_information) {
            best_information = information;
            best = q;
          }
        }
      }
    }
    if (best_information > 0.0) {
      return best;
    }
  }
  return std::nullopt;
}

std::string poseInWords(const CalibrationModel& model, const Eigen::Vector3d& q) {
  const auto& joints = model.space().nominal().joints;
  std::string words;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const double angle = q[static_cast<Eigen::Index>(k)];
    if (k == 2 || angle != 0.0) {
      words += (words.empty() ? "" : ", ") + joints[k].name + " near " + format("%.2f rad", angle);
    }
  }
  return words;
}

std::string adviceForJoint(const CalibrationModel& model,
                           Part part,
                           std::size_t index,
                           double least_motion) {
  constexpr double kAmple = 3.0;  // times what just counts as moved
  const std::string& name = model.space().nominal().joints[index].name;
  if (part == Part::kJointOffset) {
    return "The offset of " + name +
           " is not told apart by the samples: add poses with all joints moved.";
  }
  return "The axis of " + name + " is not observable: move " + name + " by " +
         format("%.2g rad or more.", kAmple * least_motion);
}

std::string coarseInWords(const std::string& effect) {
  return "The samples cannot tell " + effect +
         " apart from the other parameters, and it is stated more coarsely than "
         "estimation.unobservable_stddev: measure it better, and state that.";
}

std::string adviceForEffect(const CalibrationModel& model, std::size_t coordinate) {
  const EffectLayout& effects = model.space().effects();
  const auto at = static_cast<Eigen::Index>(coordinate);
  if (effects.statedVariance(at) > 0.0) {
    return coarseInWords(effects.name(at));
  }
  return "The samples cannot tell " + effects.name(at) +
         " apart from the other parameters: switch off effects." + effects.at(at).name +
         ", or add poses over the whole workspace.";
}

std::string adviceForTorque(const CalibrationModel& model,
                            const CycleRequest& request,
                            const Eigen::VectorXd& x,
                            const SampleCoverage& coverage,
                            Part part,
                            std::size_t index) {
  const bool is_pole = part == Part::kPole;
  const bool is_seen = (is_pole ? coverage.poles : coverage.coils).at(index) > 0;
  const std::size_t coil = is_pole ? request.coil.value_or(0) : index;
  std::string words = (is_pole ? "Pole " : "Coil ") + std::to_string(numberOf(index));
  words += is_seen ? " is seen too weakly: "
                   : (is_pole ? " is seen by no sample: " : " sees no pole in any sample: ");
  const auto pose =
      bestPose(model, x, coil, is_pole ? std::optional<std::size_t>(index) : std::nullopt);
  if (!pose) {
    return words + "no pose of the workspace brings it within reach of coil " +
           std::to_string(numberOf(coil)) + ".";
  }
  return words + "excite coil " + std::to_string(numberOf(coil)) + " with " +
         poseInWords(model, *pose) + ".";
}

}  // namespace

std::vector<std::string> adviceForUnobservable(const CalibrationModel& model,
                                               const std::vector<Sample>& samples,
                                               const std::vector<Observation>& observations,
                                               const CycleRequest& request,
                                               const Eigen::VectorXd& x,
                                               const EstimationOptions& options,
                                               const std::vector<Eigen::Index>& unobservable) {
  if (unobservable.empty()) {
    return {};
  }
  const SampleCoverage coverage =
      sampleCoverage(model, samples, observations, x, options.current_threshold);
  std::vector<std::string> advice;
  std::map<std::pair<Part, std::size_t>, bool> told;
  for (const Eigen::Index parameter : unobservable) {
    const ParameterId id = model.space().id(parameter);
    const Part part = partOf(id.kind);
    if (!told.emplace(std::make_pair(part, id.index), true).second) {
      continue;
    }
    if (part == Part::kEffect) {
      advice.push_back(adviceForEffect(model, id.index));
      continue;
    }
    advice.push_back(part == Part::kJointOffset || part == Part::kJointAxis
                         ? adviceForJoint(model, part, id.index, options.min_joint_motion)
                         : adviceForTorque(model, request, x, coverage, part, id.index));
  }
  return advice;
}

std::string adviceForCoarse(const ParameterSpace& space, double unobservable_stddev) {
  const EffectLayout& effects = space.effects();
  for (const PlacedEffect& effect : effects.effects()) {
    const double scale = effect.effect->scale();
    const Eigen::MatrixXd stated =
        scale * scale *
        effects.statedCovariance().block(effect.first, effect.first, effect.size(), effect.size());
    // About one axis it may be known far worse than about the others.
    if (symmetricEigen(stated).values.maxCoeff() > unobservable_stddev * unobservable_stddev) {
      return coarseInWords(effect.name);
    }
  }
  return {};
}

}  // namespace sac
