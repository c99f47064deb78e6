#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/base/axis_chart.hpp"

namespace sac {

/// A pole and a coil of which the one is scanned: where the other is, rotor frame, and the current
/// times all strengths [A].
struct ScannedPartner {
  Eigen::Vector3d axis_rotor;
  double weight;
};

/// One torque as a function of the scanned axis alone.
struct ScannedTorque {
  Eigen::Vector3d rest;      ///< measured without what all else exerts [N·m], rotor frame
  Eigen::Matrix3d to_rotor;  ///< of the scanned axis
  Eigen::Matrix3d whitening;
  std::vector<ScannedPartner> partners;
};

/// Another minimum of the misfit of an axis.
struct ScannedPlace {
  Eigen::Vector2d place;  ///< in the chart of the axis [rad]
  double gain;            ///< by how much the misfit is smaller there than at the present place
};

/// The robust misfit of the torques of one pole or coil over its two angles, all else held.
class AxisScan {
 public:
  /// Keeps references to curve and chart. `range`: half width of the scan [rad]; `transition`:
  /// whitened norm beyond which a misfit fades.
  AxisScan(const TorqueCurve& curve,
           const AxisChart& chart,
           bool is_pole,
           std::vector<ScannedTorque> torques,
           double range,
           double transition);

  /// Minima that are not the one of `present`: beyond what its torques leave open of it.
  std::vector<ScannedPlace> others(const Eigen::Vector2d& present) const;

 private:
  /// Half the gradient and half the Gauss–Newton Hessian beside the misfit.
  struct Normal {
    double misfit = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  };

  double misfit(const Eigen::Vector2d& place) const;
  Normal linearized(const Eigen::Vector2d& place) const;
  Eigen::Vector2d descended(Eigen::Vector2d place) const;
  bool isWithin(const Eigen::Vector2d& place) const {
    return place.cwiseAbs().maxCoeff() <= range_ + step_;
  }
  std::vector<Eigen::Vector2d> localMinima() const;

  const TorqueCurve& curve_;
  const AxisChart& chart_;
  bool is_pole_;
  std::vector<ScannedTorque> torques_;
  double limit_;
  double range_;
  int steps_;  ///< from the nominal axis to the edge of the scan
  double step_;
};

}  // namespace sac
