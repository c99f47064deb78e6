#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"

#include <string>

#include "spherical_actuator_calibration/base/axis_chart.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// Errors of the angles may lead over the pole of the coordinates; the axis then comes down on the
/// other side.
template <typename PoleOrCoil>
void disturb(PoleOrCoil& axis, double angle_error, double strength_error, NoiseSource& noise) {
  const double polar = axis.polar + noise.uniform(angle_error);
  const double azimuth = axis.azimuth + noise.uniform(angle_error);
  const AxisAngles angles = anglesFromAxis(axisFromAngles(polar, azimuth), azimuth);
  axis.polar = angles.polar;
  axis.azimuth = angles.azimuth;
  axis.gain *= 1.0 + noise.uniform(strength_error);
}

}  // namespace

void validate(const ManufacturingErrors& errors) {
  // Beyond, the disturbed actuator has no likeness to the nominal one.
  const ValueRange angle = ValueRange::closed(0.0, 0.5, "rad");
  requireInRange("error of joint offsets", errors.joint_offset, angle);
  requireInRange("error of joint axes", errors.joint_axis, angle);
  requireInRange("error of pole angles", errors.pole_angle, angle);
  requireInRange("error of coil angles", errors.coil_angle, angle);
  requireInRange("error of strength", errors.strength, ValueRange::closed(0.0, 0.5));
  requireInRange("stretch of the curve", errors.curve_stretch, ValueRange::closed(-0.2, 0.2));
}

TorqueCurveDescription stretchedCurve(const TorqueCurveDescription& curve, double stretch) {
  const double wider = 1.0 + stretch;
  TorqueCurveDescription result = curve;
  double power = 1.0;
  for (double& coefficient : result.coefficients) {
    coefficient /= power;
    power *= wider;
  }
  for (double* angle : {&result.blend_start, &result.support_begin, &result.support_end}) {
    *angle *= wider;
  }
  return result;
}

Actuator manufacturedActuator(const Actuator& nominal,
                              const ManufacturingErrors& errors,
                              std::uint64_t seed) {
  validate(errors);
  NoiseSource noise(seed, RandomPurpose::kManufacturingErrors);
  Actuator made = nominal;
  for (std::size_t k = 0; nominal.has_joints && k < kJoints; ++k) {
    JointAxis& joint = made.joints[k];
    joint.offset += noise.uniform(errors.joint_offset);
    const double u = noise.uniform(errors.joint_axis);
    const double v = noise.uniform(errors.joint_axis);
    joint.axis = AxisChart::aroundAxis(joint.axis).axis(u, v);
  }
  for (PoleAxis& pole : made.poles) {
    disturb(pole, errors.pole_angle, errors.strength, noise);
  }
  for (CoilAxis& coil : made.coils) {
    disturb(coil, errors.coil_angle, errors.strength, noise);
  }
  if (made.torque_curve && errors.curve_stretch != 0.0) {
    made.torque_curve = stretchedCurve(*made.torque_curve, errors.curve_stretch);
  }
  return made;
}

}  // namespace sac
