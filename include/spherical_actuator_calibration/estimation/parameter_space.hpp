#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/base/axis_chart.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"

namespace sac {

/// What a parameter is. The order of the groups is the order of the coordinate vector.
enum class ParameterKind {
  kJointOffset,
  kJointAxisU,
  kJointAxisV,
  kPolePolar,
  kPoleAzimuth,
  kCoilPolar,
  kCoilAzimuth,
  kEffect,
};

/// One parameter: its kind and the joint, pole or coil it belongs to, or the coordinate of the
/// EffectLayout that it is, counted from 0.
struct ParameterId {
  ParameterKind kind;
  std::size_t index;
};

/// Of a residual by all coordinates of a ParameterSpace, 3×P.
using ResidualJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;

/// Minimal coordinates of everything that calibration identifies, around one nominal actuator.
///
/// The coordinate vector x has 9 + 2m + 2l entries [rad]: (offset, u, v) of each joint, (u, v) of
/// each pole, (u, v) of each coil; 9 less for a rotor without joints; then those of the laboratory
/// effects that are modelled (EffectLayout). It is zero at the nominal actuator; offsets are
/// deviations from nominal, axes are AxisChart coordinates around the nominal axis. Every estimate
/// and covariance of this package lives in these coordinates; values for people (polar, azimuth)
/// are derived from them.
class ParameterSpace {
 public:
  /// Throws ConfigError when `nominal` is not valid or cannot have one of the effects.
  explicit ParameterSpace(Actuator nominal, const EffectSelection& effects = {});

  const Actuator& nominal() const { return nominal_; }
  Eigen::Index size() const { return size_; }
  /// kJoints, or 0 where the description has none.
  std::size_t joints() const { return joint_charts_.size(); }
  std::size_t poles() const { return pole_charts_.size(); }
  std::size_t coils() const { return coil_charts_.size(); }

  /// Number of coordinates of a joint (offset, u, v) and of a pole or coil (u, v).
  static constexpr Eigen::Index kPerJoint = 3;
  static constexpr Eigen::Index kPerAxis = 2;

  /// First coordinate of joint k, pole i, coil j, all counted from 0.
  Eigen::Index joint(std::size_t k) const { return kPerJoint * static_cast<Eigen::Index>(k); }
  Eigen::Index pole(std::size_t i) const {
    return joint(joints()) + kPerAxis * static_cast<Eigen::Index>(i);
  }
  Eigen::Index coil(std::size_t j) const {
    return pole(poles()) + kPerAxis * static_cast<Eigen::Index>(j);
  }

  /// First coordinate of the laboratory effects, whose layout is effects().
  Eigen::Index effect() const { return coil(coils()); }
  const EffectLayout& effects() const { return effects_; }

  const AxisChart& jointChart(std::size_t k) const { return joint_charts_[k]; }
  const AxisChart& poleChart(std::size_t i) const { return pole_charts_[i]; }
  const AxisChart& coilChart(std::size_t j) const { return coil_charts_[j]; }

  ParameterId id(Eigen::Index parameter) const;
  /// Name as in ParameterEstimate messages: joint_1/offset, joint_1/axis_u, pole_3/polar,
  /// coil_7/azimuth, torque_bias/x.
  std::string name(Eigen::Index parameter) const;
  /// Unit of its value for people: rad, N·m, or 1.
  std::string unit(Eigen::Index parameter) const;

  /// Actuator at the coordinates: what they do not hold is as in the nominal one. Of the effects,
  /// those of strength are in its gains and its torque curve.
  Actuator actuatorAt(const Eigen::VectorXd& x) const;
  /// Geometric coordinates of an actuator with the same numbers of poles and coils; those of
  /// effects are zero. Throws DataError otherwise.
  Eigen::VectorXd coordinatesOf(const Actuator& actuator) const;

  /// Values for people, in the order of the coordinates [rad]: offset, axis_u, axis_v, polar,
  /// azimuth; effects in their own units.
  Eigen::VectorXd reportedValues(const Eigen::VectorXd& x) const;
  /// Standard deviations [rad] of reportedValues() for a covariance of the coordinates at x. The
  /// azimuth of an axis at polar = ±π/2 is undefined: its standard deviation is capped at π.
  Eigen::VectorXd reportedStddevs(const Eigen::VectorXd& x,
                                  const Eigen::MatrixXd& covariance) const;

 private:
  Actuator nominal_;
  std::vector<AxisChart> joint_charts_;
  std::vector<AxisChart> pole_charts_;
  std::vector<AxisChart> coil_charts_;
  EffectLayout effects_;
  Eigen::Index size_;
};

}  // namespace sac
