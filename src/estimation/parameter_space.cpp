#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

/// ∂(polar, azimuth)/∂(u, v) of an axis given by angles; rows scaled by cos(polar) never below a
/// floor so that the result stays finite where the azimuth is undefined.
Eigen::Matrix2d anglesJacobian(const AxisChart& chart,
                               double u,
                               double v,
                               const AxisAngles& angles) {
  constexpr double kSmallestCosine = 1e-9;
  const AxisChart local = AxisChart::aroundAngles(angles.polar, angles.azimuth);
  const Eigen::Matrix<double, 3, 2> d_axis = chart.jacobian(u, v);
  Eigen::Matrix2d J;
  J.row(0) = local.basisU().transpose() * d_axis;
  J.row(1) = local.basisV().transpose() * d_axis /
             std::max(std::abs(std::cos(angles.polar)), kSmallestCosine);
  return J;
}

/// Sets the angles of a nominal pole or coil to those at its coordinates. An axis at its nominal
/// place keeps its nominal angles to the last bit.
template <typename PoleOrCoil>
void moveAngles(const AxisChart& chart, const Eigen::Vector2d& coordinates, PoleOrCoil& axis) {
  if (coordinates.isZero(0.0)) {
    return;
  }
  const AxisAngles angles =
      anglesFromAxis(chart.axis(coordinates[0], coordinates[1]), axis.azimuth);
  axis.polar = angles.polar;
  axis.azimuth = angles.azimuth;
}

}  // namespace

ParameterSpace::ParameterSpace(Actuator nominal, const EffectSelection& effects)
    : nominal_(std::move(nominal)) {
  validate(nominal_);
  for (JointAxis& joint : nominal_.joints) {
    joint.axis.normalize();
    if (nominal_.has_joints) {
      joint_charts_.push_back(AxisChart::aroundAxis(joint.axis));
    }
  }
  for (const PoleAxis& pole : nominal_.poles) {
    pole_charts_.push_back(AxisChart::aroundAngles(pole.polar, pole.azimuth));
  }
  for (const CoilAxis& coil : nominal_.coils) {
    coil_charts_.push_back(AxisChart::aroundAngles(coil.polar, coil.azimuth));
  }
  effects_ = EffectLayout(nominal_, effects);
  size_ = effect() + effects_.size();
}

ParameterId ParameterSpace::id(Eigen::Index parameter) const {
  const auto split = [](Eigen::Index offset, Eigen::Index per, ParameterKind first) {
    return ParameterId{
        static_cast<ParameterKind>(static_cast<int>(first) + static_cast<int>(offset % per)),
        static_cast<std::size_t>(offset / per)};
  };
  if (parameter < pole(0)) {
    return split(parameter, kPerJoint, ParameterKind::kJointOffset);
  }
  if (parameter < coil(0)) {
    return split(parameter - pole(0), kPerAxis, ParameterKind::kPolePolar);
  }
  if (parameter < effect()) {
    return split(parameter - coil(0), kPerAxis, ParameterKind::kCoilPolar);
  }
  return {ParameterKind::kEffect, static_cast<std::size_t>(parameter - effect())};
}

std::string ParameterSpace::name(Eigen::Index parameter) const {
  const ParameterId which = id(parameter);
  const std::string number = std::to_string(numberOf(which.index));
  switch (which.kind) {
    case ParameterKind::kJointOffset:
      return "joint_" + number + "/offset";
    case ParameterKind::kJointAxisU:
      return "joint_" + number + "/axis_u";
    case ParameterKind::kJointAxisV:
      return "joint_" + number + "/axis_v";
    case ParameterKind::kPolePolar:
      return "pole_" + number + "/polar";
    case ParameterKind::kPoleAzimuth:
      return "pole_" + number + "/azimuth";
    case ParameterKind::kCoilPolar:
      return "coil_" + number + "/polar";
    case ParameterKind::kCoilAzimuth:
      return "coil_" + number + "/azimuth";
    case ParameterKind::kEffect:
      return effects_.name(static_cast<Eigen::Index>(which.index));
  }
  throw DataError("Parameter " + std::to_string(parameter) + " does not exist.");
}

std::string ParameterSpace::unit(Eigen::Index parameter) const {
  return parameter < effect() ? "rad" : effects_.at(parameter - effect()).unit;
}

Actuator ParameterSpace::actuatorAt(const Eigen::VectorXd& x) const {
  Actuator actuator = nominal_;
  for (std::size_t k = 0; k < joints(); ++k) {
    const Eigen::Index at = joint(k);
    actuator.joints[k].offset += x[at];
    actuator.joints[k].axis = joint_charts_[k].axis(x[at + 1], x[at + 2]).normalized();
  }
  for (std::size_t i = 0; i < poles(); ++i) {
    moveAngles(pole_charts_[i], x.segment<2>(pole(i)), actuator.poles[i]);
  }
  for (std::size_t j = 0; j < coils(); ++j) {
    moveAngles(coil_charts_[j], x.segment<2>(coil(j)), actuator.coils[j]);
  }
  for (const PlacedEffect& placed : effects_.effects()) {
    placed.effect->applyTo(actuator, EffectLayout::values(placed, x.data() + effect()));
  }
  return actuator;
}

Eigen::VectorXd ParameterSpace::coordinatesOf(const Actuator& actuator) const {
  if (actuator.poles.size() != poles() || actuator.coils.size() != coils()) {
    throw DataError("An actuator of " + std::to_string(actuator.poles.size()) + " poles and " +
                    std::to_string(actuator.coils.size()) +
                    " coils does not fit a description of " + std::to_string(poles()) + " and " +
                    std::to_string(coils()) + ".");
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size_);
  for (std::size_t k = 0; k < joints(); ++k) {
    x[joint(k)] = actuator.joints[k].offset - nominal_.joints[k].offset;
    x.segment<2>(joint(k) + 1) = joint_charts_[k].coordinates(actuator.joints[k].axis.normalized());
  }
  for (std::size_t i = 0; i < poles(); ++i) {
    x.segment<2>(pole(i)) = pole_charts_[i].coordinates(
        axisFromAngles(actuator.poles[i].polar, actuator.poles[i].azimuth));
  }
  for (std::size_t j = 0; j < coils(); ++j) {
    x.segment<2>(coil(j)) = coil_charts_[j].coordinates(
        axisFromAngles(actuator.coils[j].polar, actuator.coils[j].azimuth));
  }
  return x;
}

Eigen::VectorXd ParameterSpace::reportedValues(const Eigen::VectorXd& x) const {
  const Actuator actuator = actuatorAt(x);
  Eigen::VectorXd values = x;
  for (std::size_t k = 0; k < joints(); ++k) {
    values[joint(k)] = actuator.joints[k].offset;
  }
  for (std::size_t i = 0; i < poles(); ++i) {
    values.segment<2>(pole(i)) << actuator.poles[i].polar, actuator.poles[i].azimuth;
  }
  for (std::size_t j = 0; j < coils(); ++j) {
    values.segment<2>(coil(j)) << actuator.coils[j].polar, actuator.coils[j].azimuth;
  }
  for (Eigen::Index e = 0; e < effects_.size(); ++e) {
    values[effect() + e] = effects_.nominalValue(e) + x[effect() + e] * effects_.scale(e);
  }
  return values;
}

Eigen::VectorXd ParameterSpace::reportedStddevs(const Eigen::VectorXd& x,
                                                const Eigen::MatrixXd& covariance) const {
  const Eigen::VectorXd values = reportedValues(x);
  Eigen::VectorXd stddevs = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const auto transform = [&](const AxisChart& chart, Eigen::Index at) {
    const Eigen::Matrix2d J = anglesJacobian(chart, x[at], x[at + 1], {values[at], values[at + 1]});
    const Eigen::Matrix2d angles = J * covariance.block<2, 2>(at, at) * J.transpose();
    stddevs.segment<2>(at) = angles.diagonal().cwiseMax(0.0).cwiseSqrt().cwiseMin(kPi);
  };
  for (std::size_t i = 0; i < poles(); ++i) {
    transform(pole_charts_[i], pole(i));
  }
  for (std::size_t j = 0; j < coils(); ++j) {
    transform(coil_charts_[j], coil(j));
  }
  for (Eigen::Index e = 0; e < effects_.size(); ++e) {
    stddevs[effect() + e] *= effects_.scale(e);
  }
  return stddevs;
}

}  // namespace sac
