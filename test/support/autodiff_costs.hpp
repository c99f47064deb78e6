#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

/// The residuals of CalibrationModel stated a second time, straight from the equations of
/// the paper and without a derivative by hand: Ceres differentiates them. What the analytic costs
/// are checked against and measured against.
namespace sac::autodiff {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;

/// Unit axis at chart coordinates `uv`: the base turned by ρ about n × (u e_u + v e_v)/ρ, which is
/// the great circle that AxisChart follows.
template <typename T>
Vector3<T> chartAxis(const AxisChart& chart, const T* uv) {
  const Vector3<T> turn = chart.base().cross(chart.basisU()).cast<T>() * uv[0] +
                          chart.base().cross(chart.basisV()).cast<T>() * uv[1];
  const Vector3<T> base = chart.base().cast<T>();
  Vector3<T> axis;
  ceres::AngleAxisRotatePoint(turn.data(), base.data(), axis.data());
  return axis;
}

/// R_stator_rotor, the product of exponentials (paper (1)), at raw sensor angles `q` [rad] and the
/// joint block (9) of the coordinates.
template <typename T>
Matrix3<T> rotorOrientation(const ParameterSpace& space,
                            const Eigen::Vector3d& q,
                            const T* joints) {
  Matrix3<T> R = Matrix3<T>::Identity();
  for (std::size_t k = 0; k < kJoints; ++k) {
    const T* at = joints + space.joint(k);
    const double nominal_angle = q[static_cast<Eigen::Index>(k)] + space.nominal().joints[k].offset;
    const Vector3<T> turn = chartAxis(space.jointChart(k), at + 1) * (at[0] + nominal_angle);
    Matrix3<T> exponential;
    ceres::AngleAxisToRotationMatrix(turn.data(), exponential.data());
    R = R * exponential;
  }
  return R;
}

/// f(ψ) [N·m/A] of the smooth curve, ψ in rad: odd cubic, polynomial, cubic to zero.
template <typename T>
T curveValue(const TorqueCurve& curve, const T& psi) {
  if (psi < curve.blendStart()) {
    return psi * (curve.linearCoefficient() + curve.cubicCoefficient() * psi * psi);
  }
  if (psi > curve.supportEnd()) {
    return T(0.0);
  }
  if (psi <= curve.supportBegin()) {
    T value(0.0);
    for (auto c = curve.coefficientsInRadians().rbegin(); c != curve.coefficientsInRadians().rend();
         ++c) {
      value = value * psi + *c;
    }
    return value;
  }
  const double width = curve.supportEnd() - curve.supportBegin();
  const double value = curve.value(curve.supportBegin());
  const double slope = curve.derivative(curve.supportBegin());
  const T t = (psi - curve.supportBegin()) / width;
  return (1.0 - t) * (1.0 - t) * (value * (1.0 + 2.0 * t) + slope * width * t);
}

/// W ln(R_a R(q)ᵀ)^∨ over the joint block. Keeps references.
class OrientationResidual {
 public:
  OrientationResidual(const CalibrationModel& model,
                      const Sample& sample,
                      const Eigen::Matrix3d& whitening)
      : model_(model), sample_(sample), whitening_(whitening) {}

  template <typename T>
  bool operator()(const T* joints, T* residual) const {
    const Matrix3<T> R = rotorOrientation(model_.space(), sample_.joint_position, joints);
    const Matrix3<T> error = sample_.R_stator_rotor.cast<T>() * R.transpose();
    Vector3<T> y;
    ceres::RotationMatrixToAngleAxis(error.data(), y.data());
    Eigen::Map<Vector3<T>> whitened(residual);
    whitened = whitening_.cast<T>() * y;
    return true;
  }

 private:
  const CalibrationModel& model_;
  const Sample& sample_;
  Eigen::Matrix3d whitening_;
};

/// W (T_measured − T_model) with one excited coil, over the joint block, the pole block and that
/// coil's block (paper (19–23)). Undefined where a pole and the coil are exactly aligned, as the
/// paper's form is. Keeps references.
class TorqueResidual {
 public:
  TorqueResidual(const CalibrationModel& model,
                 const Sample& sample,
                 const Excitation& excitation,
                 const Eigen::Matrix3d& whitening)
      : model_(model), sample_(sample), excitation_(excitation), whitening_(whitening) {}

  template <typename T>
  bool operator()(const T* joints, const T* poles, const T* coil, T* residual) const {
    const ParameterSpace& space = model_.space();
    const Matrix3<T> R = rotorOrientation(space, sample_.joint_position, joints);
    const Vector3<T> s = R.transpose() * chartAxis(space.coilChart(excitation_.coil), coil);
    const double current = excitation_.current * space.nominal().coils[excitation_.coil].gain;
    Vector3<T> misfit = sample_.torque.cast<T>();
    for (std::size_t i = 0; i < space.poles(); ++i) {
      const Vector3<T> r = chartAxis(space.poleChart(i), poles + 2 * i);
      const T kappa = r.dot(s);
      if (kappa <= model_.curve().cosSupportEnd()) {
        continue;
      }
      const Vector3<T> normal = r.cross(s);
      const T sine = normal.norm();
      using std::atan2;
      const T f = curveValue(model_.curve(), atan2(sine, kappa));
      const PoleAxis& pole = space.nominal().poles[i];
      misfit -= (pole.polarity * pole.gain * current * f / sine) * normal;
    }
    Eigen::Map<Vector3<T>> whitened(residual);
    whitened = whitening_.cast<T>() * misfit;
    return true;
  }

 private:
  const CalibrationModel& model_;
  const Sample& sample_;
  Excitation excitation_;
  Eigen::Matrix3d whitening_;
};

using OrientationCost = ceres::AutoDiffCostFunction<OrientationResidual, 3, 9>;
/// For an actuator of `kPoles` poles.
template <int kPoles>
using TorqueCost = ceres::AutoDiffCostFunction<TorqueResidual, 3, 9, 2 * kPoles, 2>;

}  // namespace sac::autodiff
