#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/base/axis_chart.hpp"

namespace sac {

/// A pole or coil axis, rotor or stator frame, with ∂axis/∂(u, v).
struct AxisPoint {
  Eigen::Vector3d axis;
  Eigen::Matrix<double, 3, 2> d_axis;
};

/// `uv`: both coordinates of the chart.
inline AxisPoint axisPoint(const AxisChart& chart, const double* uv) {
  AxisPoint point;
  chart.evaluate(uv[0], uv[1], point.axis, point.d_axis);
  return point;
}

}  // namespace sac
