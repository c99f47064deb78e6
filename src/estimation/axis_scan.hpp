#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/tabulated_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/base/axis_chart.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

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

/// The torques that a scan goes by.
struct ScannedTorques {
  std::vector<ScannedTorque> torques;
  double each_stands_for = 1.0;  ///< so many measured ones, where there are very many
};

/// Another minimum of the misfit of an axis.
struct ScannedPlace {
  Eigen::Vector2d place;  ///< in the chart of the axis [rad]
  /// By how much the misfit of all measured torques is smaller there than at the present place.
  double gain;
};

/// The robust misfit of the torques of one pole or coil over its two angles, all else held.
class AxisScan {
 public:
  /// Keeps references to curves and chart. `range`: half width of the scan [rad]; `transition`:
  /// whitened norm beyond which a misfit fades.
  AxisScan(const TorqueCurve& curve,
           const TabulatedCurve& tabulated_curve,
           const AxisChart& chart,
           bool is_pole,
           ScannedTorques torques,
           double range,
           double transition);

  /// Minima that are not the one of `present`: beyond what its torques leave open of it. Of few
  /// torques also places in the valley of `present` that are no minima.
  std::vector<ScannedPlace> others(const Eigen::Vector2d& present) const;

  /// How far from the nominal axis a scan of this range looks [rad].
  static double reach(double range);

 private:
  struct Normal {
    double misfit = 0.0;  ///< by the robust loss
    InformationSum sum{2};
  };

  double coarseMisfit(const Eigen::Vector2d& place) const;
  Normal linearized(const Eigen::Vector2d& place) const;
  Eigen::Vector2d descended(Eigen::Vector2d place, const Eigen::Matrix2d& allowed) const;
  bool isWithin(const Eigen::Vector2d& place) const {
    return place.cwiseAbs().maxCoeff() <= range_ + step_;
  }
  std::vector<Eigen::Vector2d> localMinima() const;
  std::vector<Eigen::Vector2d> alongValley(const Eigen::Vector2d& present,
                                           const Eigen::Matrix2d& information) const;

  const TorqueCurve& curve_;
  const TabulatedCurve& tabulated_curve_;
  const AxisChart& chart_;
  bool is_pole_;
  ScannedTorques scanned_;
  double limit_;
  double range_;
  int steps_;  ///< from the nominal axis to the edge of the scan
  double step_;
};

}  // namespace sac
