#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "spherical_actuator_calibration/actuator/unit_identity.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// Angles and strength of a pole or coil.
template <typename Axis, typename Message>
void fillAxis(const Axis& axis, const AxisStddev& stddev, Message& message) {
  message.polar = axis.polar;
  message.polar_stddev = stddev.polar.value_or(kUnknown);
  message.azimuth = axis.azimuth;
  message.azimuth_stddev = stddev.azimuth.value_or(kUnknown);
  message.gain = axis.gain;
  message.gain_stddev = stddev.gain.value_or(kUnknown);
}

/// Entries that are not identified have zero in the description.
template <typename Values, typename Field>
void fillStddevs(const std::optional<Values>& stddevs, Field& field) {
  for (std::size_t n = 0; n < field.size(); ++n) {
    field[n] = stddevs && (*stddevs)[n] > 0.0 ? (*stddevs)[n] : kUnknown;
  }
}

void fillCorrection(const ReadingCorrection& correction,
                    const JointStddev& stddev,
                    msg::JointAxis& item) {
  std::copy(correction.linear.begin(), correction.linear.end(), item.linear.begin());
  std::copy(correction.harmonics.begin(), correction.harmonics.end(), item.harmonics.begin());
  fillStddevs(stddev.linear, item.linear_stddev);
  fillStddevs(stddev.harmonics, item.harmonics_stddev);
}

/// `stddev`: of a curve that is identified; else a table may state its own.
msg::TorqueCurve curveToRos(const TorqueCurveDescription& curve,
                            const std::optional<TorqueCurveStddev>& stddev) {
  msg::TorqueCurve message;
  message.in_degrees = static_cast<std::uint8_t>(curve.angle_unit == AngleUnit::kDegree);
  message.coefficients = curve.coefficients;
  message.table_angles = curve.table.angles;
  message.table_torques = curve.table.torques;
  message.blend_start = curve.blend_start;
  message.support = {curve.support_begin, curve.support_end};
  if (stddev) {
    message.stddev_angles = stddev->angles;
    message.stddevs = stddev->torques;
  } else if (!curve.table.stddevs.empty()) {
    message.stddev_angles = curve.table.angles;
    message.stddevs = curve.table.stddevs;
  }
  return message;
}

/// Nothing where the message has no curve.
std::optional<TorqueCurveDescription> curveFromRos(const msg::TorqueCurve& message) {
  if (message.coefficients.empty() && message.table_angles.empty()) {
    return std::nullopt;
  }
  TorqueCurveDescription curve;
  curve.angle_unit = message.in_degrees != 0 ? AngleUnit::kDegree : AngleUnit::kRadian;
  curve.coefficients = message.coefficients;
  curve.table.angles = message.table_angles;
  curve.table.torques = message.table_torques;
  curve.blend_start = message.blend_start;
  curve.support_begin = message.support[0];
  curve.support_end = message.support[1];
  return curve;
}

msg::OrientationMap mapToRos(const OrientationMapDescription& map) {
  msg::OrientationMap message;
  std::copy(map.length.begin(), map.length.end(), message.length.begin());
  std::copy(map.amplitude.begin(), map.amplitude.end(), message.amplitude.begin());
  std::copy(map.noise.begin(), map.noise.end(), message.noise.begin());
  message.tracker_noise = map.tracker_noise;
  std::transform(
      map.readings.begin(), map.readings.end(), std::back_inserter(message.readings), vectorToRos);
  std::transform(map.rotations.begin(),
                 map.rotations.end(),
                 std::back_inserter(message.rotations),
                 vectorToRos);
  return message;
}

/// Null where the message has no points. Throws ConfigError for what is no map.
std::shared_ptr<const OrientationMap> mapFromRos(const msg::OrientationMap& message) {
  if (message.readings.empty() && message.rotations.empty()) {
    return nullptr;
  }
  OrientationMapDescription map;
  std::copy(message.length.begin(), message.length.end(), map.length.begin());
  std::copy(message.amplitude.begin(), message.amplitude.end(), map.amplitude.begin());
  std::copy(message.noise.begin(), message.noise.end(), map.noise.begin());
  map.tracker_noise = message.tracker_noise;
  std::transform(message.readings.begin(),
                 message.readings.end(),
                 std::back_inserter(map.readings),
                 vectorFromRos);
  std::transform(message.rotations.begin(),
                 message.rotations.end(),
                 std::back_inserter(map.rotations),
                 vectorFromRos);
  return std::make_shared<OrientationMap>(std::move(map));
}

}  // namespace

msg::ActuatorParameters parametersToRos(const Actuator& actuator, const ParameterStddevs& stddevs) {
  msg::ActuatorParameters message;
  message.actuator = actuator.name;
  message.serial = actuator.serial;
  message.has_joints = static_cast<std::uint8_t>(actuator.has_joints);
  for (std::size_t k = 0; actuator.has_joints && k < kJoints; ++k) {
    const JointStddev& stddev = stddevs.joints[k];
    message.joints[k].axis = vectorToRos(actuator.joints[k].axis);
    message.joints[k].axis_stddev = {stddev.axis_u.value_or(kUnknown),
                                     stddev.axis_v.value_or(kUnknown)};
    message.joints[k].offset = actuator.joints[k].offset;
    message.joints[k].offset_stddev = stddev.offset.value_or(kUnknown);
    fillCorrection(actuator.joints[k].correction, stddev, message.joints[k]);
  }
  if (actuator.torque_curve) {
    message.torque_curve = curveToRos(*actuator.torque_curve, stddevs.torque_curve);
  }
  message.unbalance = vectorToRos(actuator.unbalance);
  message.unbalance_stddev =
      vectorToRos(stddevs.unbalance.value_or(Eigen::Vector3d::Constant(kUnknown)));
  if (actuator.orientation_map) {
    message.orientation_map = mapToRos(actuator.orientation_map->description());
  }
  for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
    msg::PoleAxis& item = message.poles.emplace_back();
    item.polarity = static_cast<std::int8_t>(actuator.poles[i].polarity);
    fillAxis(actuator.poles[i], stddevs.poles.empty() ? AxisStddev{} : stddevs.poles.at(i), item);
  }
  for (std::size_t j = 0; j < actuator.coils.size(); ++j) {
    msg::CoilAxis& item = message.coils.emplace_back();
    fillAxis(actuator.coils[j], stddevs.coils.empty() ? AxisStddev{} : stddevs.coils.at(j), item);
  }
  return message;
}

std::optional<Actuator> actuatorFromRos(const msg::ActuatorParameters& message,
                                        const Actuator& design) {
  if (message.poles.size() != design.poles.size() || message.coils.size() != design.coils.size() ||
      (message.has_joints != 0) != design.has_joints ||
      otherUnit(design, message.actuator, message.serial)) {
    return std::nullopt;
  }
  Actuator actuator = design;
  for (std::size_t k = 0; design.has_joints && k < kJoints; ++k) {
    actuator.joints[k].axis = vectorFromRos(message.joints[k].axis);
    actuator.joints[k].offset = message.joints[k].offset;
    ReadingCorrection& correction = actuator.joints[k].correction;
    std::copy(message.joints[k].linear.begin(),
              message.joints[k].linear.end(),
              correction.linear.begin());
    std::copy(message.joints[k].harmonics.begin(),
              message.joints[k].harmonics.end(),
              correction.harmonics.begin());
  }
  actuator.unbalance = vectorFromRos(message.unbalance);
  try {
    if (const auto curve = curveFromRos(message.torque_curve)) {
      validate(*curve);
      actuator.torque_curve = curve;
    }
    actuator.orientation_map = mapFromRos(message.orientation_map);
  } catch (const ConfigError&) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
    if (message.poles[i].polarity != design.poles[i].polarity) {
      return std::nullopt;
    }
    actuator.poles[i].polar = message.poles[i].polar;
    actuator.poles[i].azimuth = message.poles[i].azimuth;
    actuator.poles[i].gain = message.poles[i].gain;
  }
  for (std::size_t j = 0; j < actuator.coils.size(); ++j) {
    actuator.coils[j].polar = message.coils[j].polar;
    actuator.coils[j].azimuth = message.coils[j].azimuth;
    actuator.coils[j].gain = message.coils[j].gain;
  }
  return actuator;
}

}  // namespace sac
